#pragma once

namespace vantage {

/// How a frame of a sequence builds on the one before it.
struct TemporalOptions {
  /// How strongly pixels whose image did not change are drawn towards the disparity they had, see
  /// DisparityPrior::weight; 0..100, 0: frames are matched on their own. 1 is a good value.
  double weight = 0;
  /// An image did not change at a pixel where the mean over 3×3 pixels of its difference to the
  /// frame before is at most this, there and at the pixels beside it; grey levels, 0..255. Noise of
  /// σ shows as σ · √2/3 in such means, of which nine are looked at: 3 lets noise of σ = 2 pass at
  /// nearly all pixels.
  double threshold = 3;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

}  // namespace vantage
