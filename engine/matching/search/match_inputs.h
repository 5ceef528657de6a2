#pragma once

#include <span>
#include <string_view>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Disparities that attract pixels, such as those of the previous frame where the image has not
/// changed: the first stage of matching favours candidates near them (kernels/disparity_prior). A
/// pixel keeps its prior disparity unless its own costs and its neighbours' contradict it.
struct DisparityPrior {
  /// Size of the images; NaN, or a value outside the range, where a pixel has no prior. Empty: no
  /// priors for that map. Not owned.
  ImageView<const float> left_px = {};
  ImageView<const float> right_px = {};
  double weight = 1;  ///< 0..100; 1 weighs about as much as the pixel's own costs

  [[nodiscard]] bool empty() const { return left_px.empty() && right_px.empty(); }
};

/// One more image of a camera on the baseline of the reference (6.6).
struct OtherView {
  const Photograph* photograph = nullptr;
  /// Camera position relative to the reference, positive to the right; any unit, not 0.
  double baseline = 1;
};

// Checks of matching inputs. Each throws Error or UsageError with the value found and the one
// expected.

void require_equal_sizes(const Photograph& first, std::string_view first_name,
                         const Photograph& second, std::string_view second_name);
/// 1 to kernels::kMaxPartners other views; baselines finite, not 0 and distinct.
void require_different_baselines(std::span<const OtherView> others);
/// Weight in range, maps of the image's size.
void require_usable(const DisparityPrior& prior, const Photograph& image);

}  // namespace vantage
