#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/new_view.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// New views are at most this far from a camera: in baselines of a pair, in edges of a scene.
inline constexpr double kMaxViewDistance = 16;

// Thread rule: all functions here are pure.

/// (XS, YS) in baselines: (0, 0) is the left camera, (1, 0) the right one, y > 0 is below.
struct BaselinePosition {
  double x = 0;
  double y = 0;

  friend bool operator==(const BaselinePosition&, const BaselinePosition&) = default;
};

/// "XS", or "XS,YS" off the baseline.
std::string to_string(BaselinePosition position);

/// Pose of a new view: a camera like the pair's at another position, or any camera.
using ViewPose = std::variant<BaselinePosition, PosedCamera>;

/// The pose at `share` 0..1 of the way: positions, centres and matrices are interpolated linearly,
/// rotations by the shortest arc at constant speed (slerp). Errors as require_alike().
ViewPose pose_between(const ViewPose& from, const ViewPose& to, double share);

/// Throws UsageError unless both are of one kind and, if cameras, of one size.
void require_alike(const ViewPose& first, const ViewPose& second);

/// `pose` moved to its own right by `baselines`; `baseline`: length of the baseline of the pair
/// whose reference frame a camera is in.
ViewPose moved_right(const ViewPose& pose, double baselines, double baseline);

/// `views` positions on a circle of `radius_baselines` around the midpoint of the cameras, starting
/// on its right, going upwards, without repeating the first.
std::vector<BaselinePosition> orbit(double radius_baselines, int views);

/// A camera at `position` with the left one's K, rotated towards the point at `disparity_px` on the
/// principal axis of the view midway between the cameras, which appears at the principal point. No
/// roll: its x axis stays parallel to the pair's X-Z plane. Throws UsageError unless the disparity
/// is above that of infinity.
PosedCamera camera_looking_at(const RectifiedPair& pair, BaselinePosition position,
                              double disparity_px);

/// Completes `pose` for new_view(): positions are rotated towards `look_at_px` if set
/// (camera_looking_at()), and a camera of 0×0 pixels gets the size of the images. `pair` may be
/// null if no pose needs it; otherwise throws UsageError. Errors as camera_looking_at().
ViewPose placed(const ViewPose& pose, std::optional<double> look_at_px, const RectifiedPair* pair,
                int width_px, int height_px);

/// The geometry of `pose`. `pair` may be null for baseline positions. Errors as baseline_view() and
/// camera_view(); UsageError for a camera without a calibrated pair.
NewView new_view(const ViewPose& pose, const RectifiedPair* pair, int width_px, int height_px);

/// Pose of a new view over time: poses at key frames, interpolated by pose_between(), constant
/// before the first and after the last. A fixed view has one key. Thread rule: pure, as
/// all functions here.
struct ViewPath {
  struct Key {
    int frame = 0;
    ViewPose pose;
    friend bool operator==(const Key&, const Key&) = default;
  };
  std::vector<Key> keys;  ///< at least one, frames strictly increasing

  [[nodiscard]] static ViewPath fixed(const ViewPose& pose) { return {{{0, pose}}}; }
  [[nodiscard]] bool moves() const { return keys.size() > 1; }
  /// Depends on the frame alone, not on the start of a run.
  [[nodiscard]] ViewPose at(int frame) const;
  /// One more than the last key's frame.
  [[nodiscard]] int frames() const { return keys.back().frame + 1; }
  /// Throws UsageError: no key, frames that are negative or not increasing, poses of two kinds or
  /// sizes.
  void validate() const;

  friend bool operator==(const ViewPath&, const ViewPath&) = default;
};

/// Parses "0=0,48=1,96=0" or "0=0.5,-0.2,48=0.5,0.2": FRAME=XS or FRAME=XS,YS, comma-separated.
/// Throws UsageError with the expected format.
ViewPath parse_view_path(std::string_view text);
/// The text that parse_view_path() reads, for a path of positions.
std::string to_string(const ViewPath& path);

}  // namespace vantage
