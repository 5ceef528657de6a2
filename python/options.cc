#include "python/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/options/execution_settings.h"
#include "engine/options/nearest_name.h"
#include "engine/quoted_text.h"
#include "python/calls.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

std::string option_name(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

SettingValue to_value(const py::handle& object);

SettingValue to_list(const py::handle& sequence) {
  SettingValue list = SettingValue::array();
  for (const py::handle member : sequence) {
    list.push_back(to_value(member));
  }
  return list;
}

SettingValue to_value(const py::handle& object) {
  if (py::isinstance<py::bool_>(object)) {
    return object.cast<bool>();
  }
  if (py::isinstance<py::int_>(object)) {
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
    return overflow == 0 ? SettingValue(number) : SettingValue(std::string(py::str(object)));
  }
  if (py::isinstance<py::float_>(object)) {
    return object.cast<double>();
  }
  if (py::isinstance<py::str>(object) || py::isinstance<py::bytes>(object)) {
    return bytes_of(object);
  }
  if (py::isinstance<py::dict>(object)) {
    SettingValue members = SettingValue::object();
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(object)) {
      members[std::string(py::str(key))] = to_value(value);
    }
    return members;
  }
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    return to_list(object);
  }
  for (const char* const method : {"tolist", "__fspath__"}) {  // of NumPy and of paths
    if (py::hasattr(object, method)) {
      return to_value(object.attr(method)());
    }
  }
  throw UsageError(fmt::format("is of type {}, expected a number, a text or a list",
                               std::string(py::str(py::type::of(object).attr("__name__")))));
}

SettingValue to_setting(const std::string& name, const py::handle& object) {
  try {
    const SettingValue value = to_value(object);
    const bool is_range = name == "disparities" || name == "disparities-y" || name == "volume-rows";
    if (is_range && value.is_array() && value.size() == 2 && value[0].is_number_integer() &&
        value[1].is_number_integer()) {
      return fmt::format("{}:{}", value[0].get<long long>(), value[1].get<long long>());
    }
    if (name == "roi" && value.is_array() && value.size() == 4) {
      return fmt::format("{},{},{},{}", value[0].dump(), value[1].dump(), value[2].dump(),
                         value[3].dump());
    }
    const bool is_point = name == "principal-point" || name == "stereo-views";
    if (is_point && value.is_array() && value.size() == 2 && value[0].is_number() &&
        value[1].is_number()) {
      return fmt::format("{},{}", value[0].get<double>(), value[1].get<double>());
    }
    return value;
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} {}", name, error.what()));
  }
}

}  // namespace

void set_options(Settings& settings, const py::dict& options) {
  SettingValue values = SettingValue::object();
  const SettingValue known = settings.values();
  for (const auto& [key, value] : options) {
    const std::string given = py::str(key);
    const std::string name = option_name(given);
    if (!known.contains(name)) {
      std::vector<std::string> names;
      for (const auto& [known_name, unused] : known.items()) {
        names.push_back(known_name);
      }
      const std::string nearest = nearest_name(name, names);
      throw UsageError(fmt::format("unknown option '{}'{}", quotable(given),
                                   nearest.empty() ? "" : ", did you mean " + nearest + "?"));
    }
    if (!value.is_none()) {
      values[name] = to_setting(name, value);
    }
  }
  settings.take_values(values);
}

Execution& take_execution(py::dict& options) {
  ExecutionOptions chosen;
  Settings settings;
  add_execution_settings(settings, chosen);
  const SettingValue defaults = settings.values();
  py::dict given;
  for (const auto& [name, unused] : defaults.items()) {
    std::string keyword = name;
    std::replace(keyword.begin(), keyword.end(), '-', '_');
    if (options.contains(keyword.c_str())) {
      given[keyword.c_str()] = options.attr("pop")(keyword);
    }
  }
  set_options(settings, given);
  const SettingValue values = settings.values();
  if (values == defaults) {
    return default_execution();
  }
  // Guarded by the GIL.
  static std::map<std::string, Execution*> executions;
  Execution*& execution = executions[values.dump()];
  if (execution == nullptr) {
    execution = new Execution(chosen);
  }
  return *execution;
}

SettingValue read_toml(const std::string& path) {
  try {
    const py::object file = py::module_::import("builtins").attr("open")(text_of(path), "rb");
    const py::object document = py::module_::import("tomllib").attr("load")(file);
    file.attr("close")();
    return to_value(document);
  } catch (const py::error_already_set& error) {
    const std::string problem = py::str(error.value());
    if (error.matches(PyExc_OSError)) {
      throw Error(fmt::format("{}: cannot be read, expected a TOML file", path));
    }
    throw UsageError(fmt::format("{}: not TOML: {}", path, quotable(problem)));
  }
}

py::object to_python(const SettingValue& value) {
  if (value.is_boolean()) {
    return py::bool_(value.get<bool>());
  }
  if (value.is_number_integer()) {
    return py::int_(value.get<long long>());
  }
  if (value.is_number()) {
    return py::float_(value.get<double>());
  }
  if (value.is_string()) {
    return text_of(value.get<std::string>());
  }
  if (value.is_array()) {
    py::list list;
    for (const SettingValue& member : value) {
      list.append(to_python(member));
    }
    return list;
  }
  if (value.is_object()) {
    py::dict members;
    for (const auto& [name, member] : value.items()) {
      members[name.c_str()] = to_python(member);
    }
    return members;
  }
  return py::none();
}

}  // namespace vantage::python
