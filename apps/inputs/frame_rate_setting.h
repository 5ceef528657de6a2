#pragma once

#include <optional>
#include <string>

#include "engine/io/video/frame_rate.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// A rate such as 25, 29.97 or 30000/1001.
Setting& add_frame_rate_setting(Settings& settings, std::string name, FrameRate& field,
                                std::string help);
/// As above; the field is empty for "auto".
Setting& add_frame_rate_setting(Settings& settings, std::string name,
                                std::optional<FrameRate>& field, std::string help);

}  // namespace vantage::apps
