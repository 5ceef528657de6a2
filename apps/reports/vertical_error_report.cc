#include "apps/reports/vertical_error_report.h"

namespace vantage::apps {

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

}  // namespace vantage::apps
