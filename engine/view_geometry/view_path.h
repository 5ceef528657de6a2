#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/view_geometry/view_pose.h"

namespace vantage {

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
