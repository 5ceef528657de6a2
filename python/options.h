#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage::python {

/// Sets settings from keyword arguments: names as on the command line with _ in place of -, values
/// as in a TOML file; two numbers stand for a range MIN:MAX or a point X,Y, None for what is not
/// given. Throws
/// UsageError for unknown names and for values.
void set_options(Settings& settings, const pybind11::dict& options);

/// Options of threads (`threads`, `executor`, …) taken out of `options`, and their execution: one
/// for all who give the same, so that their threads are shared. It is never freed.
Execution& take_execution(pybind11::dict& options);

/// A TOML file as a value. Throws Error where it cannot be read, UsageError where it is not TOML.
SettingValue read_toml(const std::string& path);

/// A setting's value as a Python object.
pybind11::object to_python(const SettingValue& value);

}  // namespace vantage::python
