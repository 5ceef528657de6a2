#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Where a new view stands over time: at XS baselines on each key frame, linear between them, still
/// before the first and after the last. A fixed view has one key.
struct ViewTrack {
  struct Key {
    int frame = 0;
    double view_x = 0;
    friend bool operator==(const Key&, const Key&) = default;
  };
  std::vector<Key> keys;  ///< at least one, frames strictly growing

  [[nodiscard]] static ViewTrack fixed(double view_x) { return {{{0, view_x}}}; }
  [[nodiscard]] bool moves() const { return keys.size() > 1; }
  /// Depends on the frame alone, not on where a run begins.
  [[nodiscard]] double at(int frame) const;

  /// Throws UsageError: no key, frames negative or not growing, XS not within ±16.
  void validate() const;

  friend bool operator==(const ViewTrack&, const ViewTrack&) = default;
};

/// Reads "0=0,48=1,96=0": FRAME=XS, comma-separated. Throws UsageError that says what was expected.
ViewTrack parse_view_track(std::string_view text);
std::string to_string(const ViewTrack& track);

}  // namespace vantage
