#include "apps/vertical_error_report.h"

#include <fmt/format.h>

#include <cmath>

namespace vantage::apps {

SettingValue vertical_error_values(const VerticalError& error) {
  return {{"matches", error.matches},
          {"inliers", error.inliers},
          {"rms_px", error.rms_px},
          {"mean_px", error.mean_px},
          {"mean_absolute_px", error.mean_absolute_px},
          {"percentile_95_px", error.percentile_95_px},
          {"largest_px", error.largest_px},
          {"systematic_px", error.systematic_px},
          {"negative_disparity_share", error.negative_share}};
}

std::string vertical_error_text(const VerticalError& error) {
  return fmt::format("{:.2f} px RMS (mean {:.2f}, 95 % within {:.2f}, at most {:.2f}; {} points)",
                     error.rms_px, error.mean_px, error.percentile_95_px, error.largest_px,
                     error.inliers);
}

std::string exchanged_text(const VerticalError& error) {
  return fmt::format(
      "left and right look exchanged, or shifted against each other: {:.0f} % of {} points have "
      "negative disparities, {} in all",
      100 * error.negative_share, error.inliers, disparities_text(error));
}

std::string disparities_text(const VerticalError& error) {
  return fmt::format("{}:{}", static_cast<int>(std::floor(error.least_disparity_px)),
                     static_cast<int>(std::ceil(error.largest_disparity_px)));
}

}  // namespace vantage::apps
