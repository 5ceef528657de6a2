#include "apps/settings/option_reference.h"

#include <algorithm>
#include <cctype>

namespace vantage::apps {
namespace {

/// Whether a placeholder lists names to choose from ("fast|balanced") rather than describing a
/// value ("MIN:MAX|auto").
bool lists_choices(const std::string& value_name) {
  return value_name.find('|') != std::string::npos &&
         std::ranges::none_of(value_name,
                              [](unsigned char letter) { return std::isupper(letter) != 0; });
}

}  // namespace

SettingValue option_reference(const Setting& setting, bool is_common) {
  SettingValue entry = {{"name", setting.name},
                        {"group", setting.group},
                        {"help", setting.help},
                        {"positional", setting.positional},
                        {"required", setting.required},
                        {"flag", setting.flag},
                        {"list", setting.list},
                        {"common", is_common},
                        {"path", setting.path != PathRole::kNone}};
  if (setting.short_name != 0) {
    entry["short_name"] = std::string(1, setting.short_name);
  }
  if (!setting.value_name.empty()) {
    entry["value"] = setting.value_name;
  }
  if (lists_choices(setting.value_name)) {
    entry["choices"] = split(setting.value_name, '|');
  }
  const SettingValue value = setting.get();
  if (!value.is_null() && !value.is_boolean() && !(value.is_array() && value.empty())) {
    entry["default"] = value;
  }
  return entry;
}

SettingValue command_reference(const Settings& settings) {
  const std::vector<std::string_view>& common = settings.short_help();
  SettingValue options = SettingValue::array();
  for (const Setting& setting : settings.all()) {
    const bool is_common =
        common.empty() || std::ranges::find(common, setting.name) != common.end();
    options.push_back(option_reference(setting, is_common));
  }
  return {{"command", settings.command()},
          {"summary", settings.summary()},
          {"examples", settings.examples()},
          {"options", options}};
}

}  // namespace vantage::apps
