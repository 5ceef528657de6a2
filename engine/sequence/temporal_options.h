#pragma once

namespace vantage {

/// How a frame of a sequence uses the previous one.
struct TemporalOptions {
  /// How strongly unchanged pixels are attracted to their previous disparity, see
  /// DisparityPrior::weight; 0..100, 0: frames are matched independently. 1 is a good value.
  double weight = 0;
  /// A pixel is unchanged if the mean over 3×3 pixels of its difference to the previous frame is at
  /// most this, at the pixel and its neighbours; grey levels, 0..255. Noise of σ gives σ · √2/3 in
  /// such means, nine of which are checked: 3 accepts nearly all pixels with noise of σ = 2.
  double threshold = 3;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

}  // namespace vantage
