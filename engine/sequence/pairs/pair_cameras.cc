#include "engine/sequence/pairs/pair_cameras.h"

#include <algorithm>
#include <utility>

namespace vantage {

std::shared_ptr<const PairCameras::Cameras> PairCameras::of(const PairDetails& pair,
                                                            ImageExtent size) {
  const std::scoped_lock lock(mutex_);
  const auto known = std::ranges::find_if(latest_, [&](const Kept& kept) {
    return kept.calibration == pair.calibration && kept.kitti_cameras == pair.kitti_cameras &&
           kept.size.width_px == size.width_px && kept.size.height_px == size.height_px;
  });
  if (known != latest_.end()) {
    latest_.splice(latest_.begin(), latest_, known);
    return latest_.front().cameras;
  }
  const StereoCalibration read = options_.read(pair);
  Rectifier rectifier(read, size.width_px, size.height_px, options_.rectification);
  std::optional<MapCamera> camera;
  if (const std::optional<double> unit = options_.metres_per_unit(read)) {
    camera = map_camera(rectifier.pair(), options_.reference, *unit);
  }
  latest_.push_front({pair.calibration, pair.kitti_cameras, size,
                      std::make_shared<const Cameras>(
                          Cameras{.rectifier = std::move(rectifier), .map_camera = camera})});
  if (latest_.size() > kKept) {
    latest_.pop_back();
  }
  return latest_.front().cameras;
}

}  // namespace vantage
