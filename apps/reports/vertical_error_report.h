#pragma once

#include <string>
#include <string_view>

#include "engine/options/setting_value.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {

/// "rows are off by 0.52 px, which makes about 7 % more of the pixels wrong".
std::string cost_text(const VerticalError& error, std::string_view lines);

/// The numbers by name, for reports.
SettingValue vertical_error_values(const VerticalError& error);

/// "0.15 px RMS (mean 0.02, 95 % within 0.30, at most 0.91; 240 points)".
std::string vertical_error_text(const VerticalError& error);

/// "left and right look exchanged, or shifted against each other: 97 % of 240 points have negative
/// disparities, -40:2 in all"; "upper and lower" of a pair whose `lines` are "columns".
std::string exchanged_text(const VerticalError& error, std::string_view lines = "rows");

/// The disparities that the pair shows, as whole numbers for --disparities: "-3:17".
std::string disparities_text(const VerticalError& error);

}  // namespace vantage::apps
