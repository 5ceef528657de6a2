#include "python/unrectified_pairs.h"

#include <utility>

#include "engine/matching/search/epipolar/rectified_map.h"
#include "engine/matching/search/match_inputs.h"
#include "python/rectification.h"

namespace vantage::python {

std::shared_ptr<const UnrectifiedPairs::Cameras> UnrectifiedPairs::cameras_for(
    int width_px, int height_px) const {
  const std::scoped_lock lock(mutex_);
  if (!latest_ || latest_->rectifier.pair().width_px != width_px ||
      latest_->rectifier.pair().height_px != height_px) {
    Rectifier rectifier(calibration_, width_px, height_px);
    auto grids = epipolar_grids(rectifier, execution_);
    latest_ = std::make_shared<const Cameras>(Cameras{std::move(rectifier), std::move(grids)});
  }
  return latest_;
}

MatchOptions UnrectifiedPairs::match(const MatchOptions& options, const Photograph& left,
                                     const Photograph& right, const MatchRequest& request,
                                     DisparityMaps& maps, MatchReport& report) const {
  const auto cameras = cameras_for(left.width(), left.height());
  const Rectifier& rectifier = cameras->rectifier;
  MatchOptions used = options;
  if (used.disparities_auto) {
    Photograph rows_left;
    Photograph rows_right;
    rectifier.apply(left, Side::kLeft, rows_left, execution_);
    rectifier.apply(right, Side::kRight, rows_right, execution_);
    used = with_found_ranges(used, rows_left, rows_right, execution_);
  }
  UnrectifiedMatcher(used, cameras->grids, execution_)
      .match(left, right,
             {.left = request.left, .right = request.right, .probability = request.probability},
             maps, &report);
  if (on_rectified_) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (side == Side::kLeft ? request.left : request.right) {
        bring_to_rectified(rectifier, side, execution_, maps.of(side));
      }
    }
  }
  return used;
}

StereoCalibration UnrectifiedPairs::rectified_cameras(int width_px, int height_px) const {
  return rectified_calibration(cameras_for(width_px, height_px)->rectifier.pair(), calibration_);
}

Photograph UnrectifiedPairs::rectified(const Photograph& photograph, Side side) const {
  Photograph result;
  cameras_for(photograph.width(), photograph.height())
      ->rectifier.apply(photograph, side, result, execution_);
  return result;
}

}  // namespace vantage::python
