#include "python/options.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/options/execution_settings.h"
#include "engine/quoted_text.h"
#include "engine/thread_placement.h"
#include "python/calls.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

/// A reserved word of Python, which has an underscore at its end as a keyword.
constexpr std::string_view kReserved = "lambda";

std::string option_name(std::string name) {
  if (name.ends_with('_') && name.starts_with(kReserved)) {
    name.pop_back();
  }
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

/// The text of a range, a point or a rectangle that is given as a sequence of numbers; other values
/// as they are.
SettingValue with_numbers_joined(ValueKind kind, const SettingValue& value) {
  const bool is_range = kind == ValueKind::kRange;
  const std::size_t count = kind == ValueKind::kRectangle           ? 4
                            : is_range || kind == ValueKind::kPoint ? 2
                                                                    : 0;
  const auto fits = [is_range](const SettingValue& member) {
    return is_range ? member.is_number_integer() : member.is_number();
  };
  if (!value.is_array() || value.empty() || value.size() != count ||
      !std::all_of(value.begin(), value.end(), fits)) {
    return value;
  }
  std::string text;
  for (const SettingValue& member : value) {
    text += (text.empty() ? "" : is_range ? ":" : ",") + member.dump();
  }
  return text;
}

SettingValue to_setting(const Setting& setting, const py::handle& object) {
  try {
    return with_numbers_joined(setting.kind, to_value(object));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} {}", setting.name, error.what()));
  }
}

/// The names of ValueKind, in its order, for _options.py.
constexpr std::array kKindNames = {"text",   "word",    "truth",           "integer",
                                   "number", "numbers", "integer_or_text", "number_or_text",
                                   "range",  "point",   "rectangle",       "poses"};
static_assert(kKindNames.size() == static_cast<std::size_t>(ValueKind::kPoses) + 1);

py::dict row_of(const Setting& setting) {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): of pybind11
  return py::dict(
      "name"_a = keyword_of(setting.name),
      "kind"_a = kKindNames.at(static_cast<std::size_t>(setting.kind)), "words"_a = setting.words,
      "is_list"_a = setting.list, "is_path"_a = setting.path != PathRole::kNone,
      "default"_a = to_python(setting.get()), "help"_a = setting.help, "group"_a = setting.group);
}

}  // namespace

std::string keyword_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void set_options(Settings& settings, const py::dict& options) {
  SettingValue values = SettingValue::object();
  for (const auto& [key, value] : options) {
    const std::string given = py::str(key);
    const std::string name = option_name(given);
    const Setting& setting = settings.require(name, given);
    if (!value.is_none()) {
      values[name] = to_setting(setting, value);
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
  for (const Setting& setting : settings.all()) {
    const std::string keyword = keyword_of(setting.name);
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
  RemarkWarnings().warn(thread_remarks(execution->options(), execution->machine()));
  return *execution;
}

py::list option_rows(const Settings& settings, ThreadOptions threads,
                     const std::vector<std::string>& refused) {
  ExecutionOptions execution;
  Settings of_threads;
  if (threads == ThreadOptions::kTaken) {
    add_execution_settings(of_threads, execution);
  }
  py::list rows;
  for (const Settings* const part : std::array<const Settings*, 2>{&settings, &of_threads}) {
    for (const Setting& setting : part->all()) {
      if (std::ranges::find(refused, setting.name) == refused.end()) {
        rows.append(row_of(setting));
      }
    }
  }
  return rows;
}

void declare_rows(py::module_& module, const char* call, const std::function<py::list()>& rows) {
  if (!py::hasattr(module, "call_options")) {
    module.attr("call_options") = py::dict();
  }
  module.attr("call_options")[call] = py::cpp_function(rows);
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
