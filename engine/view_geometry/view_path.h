#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Where a new view stands over time: poses at key frames, what lies between as pose_between(),
/// still before the first and after the last. A fixed view has one key.
struct ViewPath {
  struct Key {
    int frame = 0;
    ViewPose pose;
    friend bool operator==(const Key&, const Key&) = default;
  };
  std::vector<Key> keys;  ///< at least one, frames strictly growing

  [[nodiscard]] static ViewPath fixed(const ViewPose& pose) { return {{{0, pose}}}; }
  [[nodiscard]] bool moves() const { return keys.size() > 1; }
  /// Depends on the frame alone, not on where a run begins.
  [[nodiscard]] ViewPose at(int frame) const;
  /// One more than the last key's frame.
  [[nodiscard]] int frames() const { return keys.back().frame + 1; }
  /// Throws UsageError: no key, frames that are negative or do not grow, poses of two kinds or
  /// sizes.
  void validate() const;

  friend bool operator==(const ViewPath&, const ViewPath&) = default;
};

/// Reads "0=0,48=1,96=0" or "0=0.5,-0.2,48=0.5,0.2": FRAME=XS or FRAME=XS,YS, comma-separated.
/// Throws UsageError that says what was expected.
ViewPath parse_view_path(std::string_view text);
/// The same text of a path of positions.
std::string to_string(const ViewPath& path);

}  // namespace vantage
