#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// A picture reduced to 32×24 grey levels: means of its luma over equal rectangles (each at least a
/// pixel).
struct Thumbnail {
  static constexpr int kWidth = 32;
  static constexpr int kHeight = 24;
  std::array<float, static_cast<std::size_t>(kWidth)* kHeight> levels = {};
};

/// Thread rule: pure.
Thumbnail make_thumbnail(const Photograph& photograph);

/// Dissimilarity of two pictures, independent of mean brightness: the mean square of the difference
/// of their thumbnails without their means, relative to the sum of their variances; 0: the same
/// picture or two without content, about 1: unrelated pictures.
double dissimilarity(const Thumbnail& first, const Thumbnail& second);

/// Finds cuts between shots, from the frames in order.
///
/// A cut is before frame t if frames t − 1 and t are unrelated (a dissimilarity above 0.3: pictures
/// of different places have 0.4 and more, frames from a driving car 0.25 and less), stand out from
/// their surroundings (above twice the median of the three steps before and the three after; a fast
/// camera changes all frames alike), and stay unrelated when either is left out: t − 2 and t, t − 1
/// and t + 1 (else t or t − 1 is a flash). Changes of brightness are no cut, nor are fades and
/// dissolves, whose frames resemble each other.
class ShotCuts {
 public:
  /// Adds the next frame; empty: unknown, which makes no cut.
  void add(const std::optional<Thumbnail>& frame);

  /// First frames of the shots, ascending and counted from 0; the first is 0 unless there are no
  /// frames.
  [[nodiscard]] std::vector<int> shot_starts() const;

 private:
  std::array<std::optional<Thumbnail>, 2> last_;  ///< the last frame, the one before
  std::vector<float> to_last_;                    ///< per frame; 0 if either is unknown
  std::vector<float> to_one_before_;
};

}  // namespace vantage
