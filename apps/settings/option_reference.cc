#include "apps/settings/option_reference.h"

#include <algorithm>
#include <string_view>

#include "engine/combinations/combination_texts.h"

namespace vantage::apps {

SettingValue option_reference(const Setting& setting, bool is_common) {
  SettingValue entry = {{"name", setting.name},
                        {"group", setting.group},
                        {"help", setting.help},
                        {"positional", setting.positional},
                        {"required", setting.required},
                        {"flag", setting.kind == ValueKind::kTruth},
                        {"list", setting.list},
                        {"common", is_common},
                        {"path", setting.path != PathRole::kNone}};
  if (setting.short_name != 0) {
    entry["short_name"] = std::string(1, setting.short_name);
  }
  if (!setting.value_name.empty()) {
    entry["value"] = setting.value_name;
  }
  if (!setting.words.empty()) {
    entry["choices"] = setting.words;
  }
  const SettingValue value = setting.get();
  if (!value.is_null() && !value.is_boolean() && !(value.is_array() && value.empty())) {
    entry["default"] = value;
  }
  return entry;
}

std::vector<std::string> not_with(const Setting& setting, const Settings& settings) {
  return vantage::not_with(setting.name, [&](std::string_view option) {
    return option == "column" ? settings.find("pairs") != nullptr
                              : settings.find(option) != nullptr;
  });
}

SettingValue combination_reference() {
  SettingValue rows = SettingValue::array();
  const auto texts = [](const std::vector<Condition>& conditions) {
    SettingValue list = SettingValue::array();
    for (const Condition& condition : conditions) {
      list.push_back(condition.text());
    }
    return list;
  };
  for (const Combination& row : combinations()) {
    if (row.message.empty()) {
      continue;
    }
    rows.push_back({{"option", row.option.text()},
                    {row.only_with.empty() ? "not_with" : "only_with",
                     texts(row.only_with.empty() ? row.with : row.only_with)},
                    {"reason", row.reason()},
                    {"preset_gives_way", row.gives_way_to.has_value()}});
  }
  return rows;
}

SettingValue command_reference(const Settings& settings) {
  const std::vector<std::string_view>& common = settings.short_help();
  SettingValue options = SettingValue::array();
  for (const Setting& setting : settings.all()) {
    const bool is_common =
        common.empty() || std::ranges::find(common, setting.name) != common.end();
    SettingValue& option = options.emplace_back(option_reference(setting, is_common));
    if (const std::vector<std::string> others = not_with(setting, settings); !others.empty()) {
      option["not_with"] = others;
    }
  }
  return {{"command", settings.command()},
          {"summary", settings.summary()},
          {"examples", settings.examples()},
          {"options", options}};
}

}  // namespace vantage::apps
