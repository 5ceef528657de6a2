#pragma once

#include <span>
#include <string_view>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Disparities that pixels are drawn towards, such as those of the frame before where the image has
/// not changed: the first stage of matching favours candidates near them (kernels/disparity_prior).
/// Such a pixel keeps its disparity unless its own costs and its neighbours' speak against it.
struct DisparityPrior {
  /// Size of the images; NaN, or a value outside the range, where a pixel has none. Empty: no pixel
  /// of that map has one. Not owned.
  ImageView<const float> left_px = {};
  ImageView<const float> right_px = {};
  double weight = 1;  ///< 0..100; 1 counts about as much as what a pixel's own costs say

  [[nodiscard]] bool empty() const { return left_px.empty() && right_px.empty(); }
};

/// One more image of a camera on the baseline of the reference (6.6).
struct OtherView {
  const Photograph* photograph = nullptr;
  /// Where its camera stands, from the reference's, to the right positive; in any unit, not 0.
  double baseline = 1;
};

// What matching cannot work with: each throws Error or UsageError, naming what it found and what it
// expected.

void require_equal_sizes(const Photograph& first, std::string_view first_name,
                         const Photograph& second, std::string_view second_name);
/// At least one other view, baselines finite, not 0 and different from each other.
void require_different_baselines(std::span<const OtherView> others);
/// Weight in range, maps of the image's size.
void require_usable(const DisparityPrior& prior, const Photograph& image);

}  // namespace vantage
