#pragma once

namespace vantage {

/// What the maps of a frame take from the frame before.
enum class Reuse {
  kNone,
  kFrame,  ///< tiles whose images did not change keep their disparities (EQUATIONS §3.14)
};

/// How a frame of a sequence uses the previous one.
struct TemporalOptions {
  /// How strongly unchanged pixels are attracted to their previous disparity, see
  /// DisparityPrior::weight; 0..100, 0: frames are matched independently. 1 is a good value.
  double weight = 0;
  /// A pixel is unchanged if the mean over 3×3 pixels of its difference to the previous frame is at
  /// most this, at the pixel and its neighbours; grey levels, 0..255. Noise of σ gives σ · √2/3 in
  /// such means, nine of which are checked: 3 accepts nearly all pixels with noise of σ = 2.
  double threshold = 3;
  /// Without reuse_obstacle() and weight.
  Reuse reuse = Reuse::kNone;

  /// Whether a frame depends on those before it in its chunk.
  [[nodiscard]] bool uses_past() const { return weight > 0 || reuse != Reuse::kNone; }

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

}  // namespace vantage
