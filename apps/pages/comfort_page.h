#pragma once

#include <map>
#include <string>

#include "engine/comfort/comfort_summary.h"
#include "engine/io/video/frame_rate.h"
#include "engine/options/setting_value.h"

namespace vantage::apps {

/// A report on comfort and what it is about.
struct ComfortPage {
  const ComfortReport& report;
  const std::map<int, FrameComfort>& frames;
  FrameRate rate;           ///< of `frames`
  const FrameTimes* times;  ///< of all frames; null: the rate is constant
  std::string input;        ///< its name

  [[nodiscard]] double seconds(int frame) const {
    return times != nullptr ? times->seconds(frame) : frame / rate.per_second();
  }
};

/// The JSON of comfort.json.
SettingValue comfort_values(const ComfortPage& page);
/// comfort.html: needs no other file and no network.
std::string make_comfort_page(const ComfortPage& page);

}  // namespace vantage::apps
