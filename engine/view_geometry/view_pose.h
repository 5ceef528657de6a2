#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/new_view.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// (XS, YS) in baselines: (0, 0) is the left camera, (1, 0) the right one, y > 0 is below.
struct BaselinePosition {
  double x = 0;
  double y = 0;

  friend bool operator==(const BaselinePosition&, const BaselinePosition&) = default;
};

/// "XS", or "XS,YS" off the baseline.
std::string to_string(BaselinePosition position);

/// Where a new view is wanted: a camera like the pair's beside them, or any camera.
using ViewPose = std::variant<BaselinePosition, PosedCamera>;

/// The pose at `share` 0..1 of the way: positions, centres and matrices on straight lines,
/// rotations by the shortest turn at constant speed (slerp). Errors as require_alike().
ViewPose pose_between(const ViewPose& from, const ViewPose& to, double share);

/// Throws UsageError unless both are of one kind and, if cameras, of one size.
void require_alike(const ViewPose& first, const ViewPose& second);

/// `pose` moved to its own right by so many baselines; `baseline` is that of the pair whose
/// reference frame a camera is in, in its unit.
ViewPose moved_right(const ViewPose& pose, double baselines, double baseline);

/// `views` positions on a circle of `radius_baselines` about the middle between the cameras,
/// beginning on its right, upwards, without repeating the first.
std::vector<BaselinePosition> orbit(double radius_baselines, int views);

/// A camera with the left one's K at `position` that is turned towards the point which lies at
/// `disparity_px` on the principal axis of the view half-way between the cameras; it appears at
/// the principal point. No roll: its x axis stays parallel to the pair's X-Z plane. Throws
/// UsageError unless the disparity is above that of infinity.
PosedCamera camera_looking_at(const RectifiedPair& pair, BaselinePosition position,
                              double disparity_px);

/// `pose` with all that new_view() needs: positions are turned towards `look_at_px` where that is
/// set (camera_looking_at()), and a camera of 0×0 pixels gets the size of the images. `pair` may be
/// null where no pose needs it. Throws UsageError where it does, and as camera_looking_at().
ViewPose placed(const ViewPose& pose, std::optional<double> look_at_px, const RectifiedPair* pair,
                int width_px, int height_px);

/// The geometry of `pose`. `pair` may be null for baseline positions. Errors as baseline_view() and
/// camera_view(); UsageError for a camera without a calibrated pair.
NewView new_view(const ViewPose& pose, const RectifiedPair* pair, int width_px, int height_px);

}  // namespace vantage
