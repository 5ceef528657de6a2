#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Where a new view stands over time: at (XS, YS) baselines on each key frame, linear between them,
/// still before the first and after the last. A fixed view has one key.
struct ViewTrack {
  struct Key {
    int frame = 0;
    BaselinePosition position;
    friend bool operator==(const Key&, const Key&) = default;
  };
  std::vector<Key> keys;  ///< at least one, frames strictly growing

  [[nodiscard]] static ViewTrack fixed(BaselinePosition position) { return {{{0, position}}}; }
  [[nodiscard]] bool moves() const { return keys.size() > 1; }
  /// Depends on the frame alone, not on where a run begins.
  [[nodiscard]] BaselinePosition at(int frame) const;

  /// Throws UsageError: no key, frames negative or not growing, XS or YS not within ±16.
  void validate() const;

  friend bool operator==(const ViewTrack&, const ViewTrack&) = default;
};

/// Reads "0=0,48=1,96=0" or "0=0.5,-0.2,48=0.5,0.2": FRAME=XS or FRAME=XS,YS, comma-separated.
/// Throws UsageError that says what was expected.
ViewTrack parse_view_track(std::string_view text);
std::string to_string(const ViewTrack& track);

}  // namespace vantage
