#pragma once

#include <map>
#include <string>

#include "apps/setting_value.h"
#include "engine/comfort/comfort_summary.h"
#include "engine/io/frame_rate.h"

namespace vantage::apps {

/// A report on comfort and what it is about.
struct ComfortPage {
  const ComfortReport& report;
  const std::map<int, FrameComfort>& frames;
  FrameRate rate;     ///< of `frames`
  std::string input;  ///< its name
};

/// The JSON of comfort.json.
SettingValue comfort_values(const ComfortPage& page);
/// comfort.html: needs no other file and no network.
std::string make_comfort_page(const ComfortPage& page);

}  // namespace vantage::apps
