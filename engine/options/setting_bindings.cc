#include <cctype>

#include "engine/options/settings.h"

// The settings of each type: how a field is set from a value and read.

namespace vantage {
namespace {

std::string upper_case(std::string text) {
  for (char& letter : text) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return text;
}

template <typename T, typename Parse>
void bind_optional(Setting& setting, std::optional<T>& field, const std::string& unset_name,
                   const Parse& parse) {
  setting.set = [&field, unset_name, parse](const SettingValue& value) {
    if (value.is_string() && value.get_ref<const std::string&>() == unset_name) {
      field.reset();
      return;
    }
    field = parse(value);
  };
  setting.words = {unset_name};
  setting.get = [&field, unset_name]() -> SettingValue {
    return field ? SettingValue(*field) : SettingValue(unset_name);
  };
}

}  // namespace

Setting& Settings::flag(std::string name, bool& field, std::string help) {
  Setting& setting = add(std::move(name), "", std::move(help));
  setting.kind = ValueKind::kTruth;
  setting.set = [&field](const SettingValue& value) { field = to_truth(value); };
  setting.get = [&field] { return field; };
  return setting;
}

Setting& Settings::integer(std::string name, int& field, std::string value_name, std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.kind = ValueKind::kInteger;
  setting.set = [&field](const SettingValue& value) { field = to_integer(value); };
  setting.get = [&field] { return field; };
  return setting;
}

Setting& Settings::number(std::string name, double& field, std::string value_name,
                          std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.kind = ValueKind::kNumber;
  setting.set = [&field](const SettingValue& value) { field = to_number(value); };
  setting.get = [&field] { return field; };
  return setting;
}

Setting& Settings::integer(std::string name, std::optional<int>& field, std::string value_name,
                           std::string help, const std::string& unset_name) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.kind = ValueKind::kInteger;
  bind_optional(setting, field, unset_name, to_integer);
  return setting;
}

Setting& Settings::number(std::string name, std::optional<double>& field, std::string value_name,
                          std::string help, const std::string& unset_name) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.kind = ValueKind::kNumber;
  bind_optional(setting, field, unset_name, to_number);
  return setting;
}

Setting& Settings::text(std::string name, std::string& field, std::string value_name,
                        std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.set = [&field](const SettingValue& value) { field = to_text(value); };
  setting.get = [&field]() -> SettingValue {
    return field.empty() ? SettingValue() : SettingValue(field);
  };
  return setting;
}

Setting& Settings::path(std::string name, std::string& field, std::string value_name,
                        std::string help) {
  Setting& setting = text(std::move(name), field, std::move(value_name), std::move(help));
  setting.path = PathRole::kOther;
  return setting;
}

Setting& Settings::input_path(std::string name, std::string& field, std::string value_name,
                              std::string help) {
  Setting& setting = path(std::move(name), field, std::move(value_name), std::move(help));
  setting.path = PathRole::kInput;
  return setting;
}

Setting& Settings::positional(std::string name, std::string& field, std::string help) {
  Setting& setting = input_path(std::move(name), field, "", std::move(help));
  setting.value_name = upper_case(setting.name);
  setting.positional = true;
  return setting;
}

}  // namespace vantage
