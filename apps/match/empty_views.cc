#include "apps/match/empty_views.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdio>

#include "apps/process/tell.h"
#include "engine/view_geometry/new_view.h"

namespace vantage::apps {

std::string why_empty(const PairWithMaps& pair, const ViewPose& pose) {
  const NewView view = new_view(pose, pair.cameras ? &*pair.cameras : nullptr, pair.left.width(),
                                pair.left.height());
  int behind = 0;
  int all = 0;
  for (int y = 0; y < pair.maps.left.disparity_px.height(); ++y) {
    for (int x = 0; x < pair.maps.left.disparity_px.width(); ++x) {
      const double d = pair.maps.left.disparity_px.at(x, y);
      if (std::isfinite(d)) {
        const double depth = view.from_left.homography.row(2).dot(Eigen::Vector3d(x, y, 1)) +
                             d * view.from_left.parallax.z();
        ++all;
        behind += depth > 0 ? 0 : 1;
      }
    }
  }
  if (all == 0) {
    return "the left map has no disparities";
  }
  const std::string frame = fmt::format("the frame of {}x{} pixels", view.width_px, view.height_px);
  if (behind == 0) {
    return "all of it is outside " + frame;
  }
  return behind == all ? "all of it is behind the camera"
                       : fmt::format("{:.0f} % of it is behind the camera, the rest outside {}",
                                     100.0 * behind / all, frame);
}

void warn_of_empty_views(const std::string& command, const PairWithMaps& pair,
                         const std::vector<ViewPose>& poses, const std::vector<int>& empty_views) {
  if (empty_views.empty()) {
    return;
  }
  const int first = empty_views.front();
  tell("{}: warning: {} of {} views show nothing of the scene, the first is view {}: {}\n", command,
       empty_views.size(), poses.size(), first + 1,
       why_empty(pair, poses[static_cast<std::size_t>(first)]));
}

}  // namespace vantage::apps
