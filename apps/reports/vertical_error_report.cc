#include "apps/reports/vertical_error_report.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/rectification/vertical_error.h"

namespace vantage::apps {

std::string cost_text(const VerticalError& error, std::string_view lines) {
  return fmt::format("{} are off by {:.2f} px, which makes about {:.0f} % more of the pixels wrong",
                     lines, error.systematic_px, more_bad_percent(error.systematic_px));
}

SettingValue vertical_error_values(const VerticalError& error) {
  return {{"matches", error.matches},
          {"inliers", error.inliers},
          {"rms_px", error.rms_px},
          {"mean_px", error.mean_px},
          {"mean_absolute_px", error.mean_absolute_px},
          {"percentile_95_px", error.percentile_95_px},
          {"largest_px", error.max_px},
          {"systematic_px", error.systematic_px},
          {"more_bad_percent", more_bad_percent(error.systematic_px)},
          {"negative_disparity_share", error.negative_share}};
}

std::string vertical_error_text(const VerticalError& error) {
  return fmt::format("{:.2f} px RMS (mean {:.2f}, 95 % within {:.2f}, at most {:.2f}; {} points)",
                     error.rms_px, error.mean_px, error.percentile_95_px, error.max_px,
                     error.inliers);
}

std::string exchanged_text(const VerticalError& error, std::string_view lines) {
  return fmt::format(
      "{} look exchanged, or shifted against each other: {:.0f} % of {} points have negative "
      "disparities, {} in all",
      lines == "columns" ? "upper and lower" : "left and right", 100 * error.negative_share,
      error.inliers, disparities_text(error));
}

std::string disparities_text(const VerticalError& error) {
  return fmt::format("{}:{}", static_cast<int>(std::floor(error.min_disparity_px)),
                     static_cast<int>(std::ceil(error.max_disparity_px)));
}

}  // namespace vantage::apps
