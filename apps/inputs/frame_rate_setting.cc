#include "apps/inputs/frame_rate_setting.h"

#include <utility>

namespace vantage::apps {
namespace {

constexpr const char* kAutomatic = "auto";

FrameRate to_frame_rate(const SettingValue& value) {
  const auto rate = parse_frame_rate(value.is_number() ? value.dump() : to_text(value));
  if (!rate) {
    reject_value(value, "frames per second above 0 up to 1000 such as 25, 29.97 or 30000/1001");
  }
  return *rate;
}

}  // namespace

Setting& add_frame_rate_setting(Settings& settings, std::string name, FrameRate& field,
                                std::string help) {
  Setting& setting = settings.add(std::move(name), "RATE", std::move(help));
  setting.set = [&field](const SettingValue& value) { field = to_frame_rate(value); };
  setting.get = [&field] { return to_string(field); };
  return setting;
}

Setting& add_frame_rate_setting(Settings& settings, std::string name,
                                std::optional<FrameRate>& field, std::string help) {
  Setting& setting = settings.add(std::move(name), "RATE", std::move(help));
  setting.set = [&field](const SettingValue& value) {
    if (value == kAutomatic) {
      field.reset();
    } else {
      field = to_frame_rate(value);
    }
  };
  setting.get = [&field]() -> SettingValue { return field ? to_string(*field) : kAutomatic; };
  return setting;
}

}  // namespace vantage::apps
