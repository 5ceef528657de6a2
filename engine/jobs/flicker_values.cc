#include "engine/jobs/flicker_values.h"

namespace vantage {

SettingValue flicker_values(const FlickerSums& sums) {
  if (sums.frames == 0) {
    return nullptr;
  }
  SettingValue views = SettingValue::array();
  for (const ViewFlickerSums& view : sums.views) {
    views.push_back({{"mean_grey_change", view.mean_grey_change()},
                     {"mean_brightness_jump", view.mean_brightness_jump(sums.frames)}});
  }
  return {{"frames", sums.frames},
          {"share_compared", sums.share_compared()},
          {"mean_disparity_change_px", sums.mean_disparity_change_px()},
          {"share_jumped", sums.share_jumped()},
          {"mean_grey_change", sums.mean_grey_change()},
          {"views", views}};
}

}  // namespace vantage
