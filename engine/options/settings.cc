#include "engine/options/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "engine/error.h"
#include "engine/io/files/encoded_text.h"
#include "engine/options/nearest_name.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

/// `value` with `convert` applied to all texts.
template <typename Convert>
SettingValue with_texts(const SettingValue& value, const Convert& convert) {
  if (value.is_string()) {
    return convert(value.get_ref<const std::string&>());
  }
  SettingValue converted = value;
  if (value.is_array()) {
    for (SettingValue& member : converted) {
      member = with_texts(member, convert);
    }
  }
  return converted;
}

}  // namespace

void Setting::assign(const SettingValue& value, const std::string& shown_name) const {
  try {
    set(value);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} {}", shown_name, error.what()));
  }
}

void Setting::assign_stored(const SettingValue& value, const std::string& shown_name) const {
  assign(path == PathRole::kNone ? value : with_texts(value, name_of_stored), shown_name);
}

SettingValue Setting::stored() const {
  return path == PathRole::kNone ? get() : with_texts(get(), stored_name);
}

bool Setting::is_empty() const {
  const SettingValue value = get();
  return value.is_null() || (value.is_array() && value.empty());
}

const Setting* Settings::find(std::string_view name) const {
  const auto setting = std::ranges::find(settings_, name, &Setting::name);
  return setting == settings_.end() ? nullptr : &*setting;
}

const Setting& Settings::require(const std::string& name, const std::string& given) const {
  if (const Setting* const setting = find(name)) {
    return *setting;
  }
  std::vector<std::string> names;
  std::ranges::transform(settings_, std::back_inserter(names), &Setting::name);
  const std::string nearest = nearest_name(name, names);
  throw UsageError(fmt::format("unknown option '{}'{}", quotable(given),
                               nearest.empty() ? "" : ", did you mean " + nearest + "?"));
}

Setting& Settings::add(std::string name, std::string value_name, std::string help) {
  Setting setting;
  setting.name = std::move(name);
  setting.value_name = std::move(value_name);
  setting.help = std::move(help);
  setting.group = group_;
  setting.changes_results = group_changes_results_;
  return settings_.emplace_back(std::move(setting));
}

SettingValue Settings::values() const {
  SettingValue values = SettingValue::object();
  for (const Setting& setting : settings_) {
    values[setting.name] = setting.get();
  }
  return values;
}

SettingValue Settings::result_values() const {
  SettingValue values = SettingValue::object();
  for (const Setting& setting : settings_) {
    if (setting.changes_results && !setting.is_empty()) {
      values[setting.name] = setting.get();
    }
  }
  return values;
}

std::vector<std::string> Settings::input_paths() const {
  std::vector<std::string> paths;
  for (const Setting& setting : settings_) {
    if (setting.path != PathRole::kInput) {
      continue;
    }
    for (const SettingValue& value : to_list(setting.get())) {
      if (value.is_string()) {
        paths.push_back(value.get<std::string>());
      }
    }
  }
  if (!file_.empty()) {
    paths.push_back(file_);
  }
  return paths;
}

void Settings::set_values(const SettingValue& values) {
  for (const auto& [key, value] : values.items()) {
    require(key, key).assign_stored(value, key);
  }
}

void Settings::take_values(const SettingValue& values) {
  set_values(values);
  for (const auto& [key, value] : values.items()) {
    set_.insert(key);
  }
}

void Settings::set_short_help(std::vector<std::string_view> names,
                              std::vector<std::string_view> examples) {
  for (const std::string_view name : names) {
    if (find(name) == nullptr) {
      throw std::logic_error(fmt::format("no setting '{}' for the short help", name));
    }
  }
  short_help_ = std::move(names);
  examples_ = std::move(examples);
}

OptionValues Settings::option_values() const {
  OptionValues values;
  for (const Setting& setting : settings_) {
    const SettingValue value = setting.get();
    const bool is_absent = setting.is_empty() || value == false || is_word(value, "auto") ||
                           is_word(value, "none") || is_word(value, "all");
    if (is_absent) {
      values.set_absent(setting.name, is_set(setting.name));
    } else if (value.is_number()) {
      values.set(setting.name, value.get<double>(), is_set(setting.name));
    } else {
      values.set(setting.name, value.is_string() ? value.get_ref<const std::string&>() : "given",
                 is_set(setting.name));
    }
  }
  return values;
}

void Settings::refuse_idle(std::initializer_list<const char*> names, std::string_view why) const {
  for (const char* const name : names) {
    if (is_set(name)) {
      throw UsageError(fmt::format("--{} has no effect {}", name, why));
    }
  }
}

}  // namespace vantage
