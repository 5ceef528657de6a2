#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage::python {

/// Sets settings from keyword arguments: names as on the command line with _ in place of -, values
/// as in a TOML file; sequences of numbers stand for ranges, points and rectangles, None for what
/// is not given. Throws UsageError for unknown names and for values.
void set_options(Settings& settings, const pybind11::dict& options);

/// Options of threads (`threads`, `executor`, …) taken out of `options`, and their execution: one
/// for all who give the same, so that their threads are shared. It is never freed. Warns where it
/// has fewer threads than asked for.
Execution& take_execution(pybind11::dict& options);

/// The keyword of an option.
std::string keyword_of(std::string name);

/// Whether a call takes the options of take_execution(), too.
enum class ThreadOptions { kNone, kTaken };

/// The rows of settings as the package documents them: a list of dicts of `name` (the keyword),
/// `kind`, `words`, `is_list`, `is_path`, `default`, `help` and `group`. Without those of the names
/// `refused`.
pybind11::list option_rows(const Settings& settings, ThreadOptions threads,
                           const std::vector<std::string>& refused);

/// Adds an entry to the dict `call_options` of the module: `call` → a function that returns the
/// rows of its options.
void declare_rows(pybind11::module_& module, const char* call,
                  const std::function<pybind11::list()>& rows);

/// Tells the package which options its function, class or method `call` takes, for documentation
/// and stubs: those that `add` adds for an Options.
template <typename Options>
void declare_options(pybind11::module_& module, const char* call, ThreadOptions threads,
                     void (*add)(Settings& settings, Options& options),
                     const std::vector<std::string>& refused = {}) {
  declare_rows(module, call, [threads, add, refused] {
    Options options;
    Settings settings;
    add(settings, options);
    return option_rows(settings, threads, refused);
  });
}

/// A TOML file as a value. Throws Error where it cannot be read, UsageError where it is not TOML.
SettingValue read_toml(const std::string& path);

/// A setting's value as a Python object.
pybind11::object to_python(const SettingValue& value);

}  // namespace vantage::python
