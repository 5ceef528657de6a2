#pragma once

#include <array>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// The largest of three grey levels of several pictures at each pixel: what is black in one picture
/// alone is not in it. Pictures of one size. Thread rule: one thread.
class BrightestLevels {
 public:
  void add(const Photograph& photograph);
  [[nodiscard]] const Image<std::uint8_t>& levels() const { return levels_; }

 private:
  Image<std::uint8_t> levels_;  ///< luma
};

/// Whether enough pixels at a border are black for black_borders() to find something in this
/// picture alone or with others. Looks at the outermost pixels only.
bool may_have_black_border(const Photograph& photograph);

/// What is not scene at the borders of the left and the right picture of a pair, 255 where it is
/// not; empty: nothing. Two kinds, both with a sharp edge to something that is not black:
/// - bars of a film: near-black, from one end of a border to the other, straight, and those above
///   and below alike in both pictures;
/// - wedges of a rectification: exactly black, their edges straight or evenly bent.
/// Dark scenes, vignettes and shadows have neither.
std::array<Mask, 2> black_borders(const Image<std::uint8_t>& left,
                                  const Image<std::uint8_t>& right);
/// Of two photographs alone.
std::array<Mask, 2> black_borders(const Photograph& left, const Photograph& right);

}  // namespace vantage
