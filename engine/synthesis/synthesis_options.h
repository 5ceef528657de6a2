#pragma once

#include <optional>

namespace vantage {

/// How holes, which neither warped image covers, are filled (EQUATIONS §6, hole filling).
enum class HoleFilling {
  kMirror,      ///< the background side mirrored along the scanline
  kSpread,      ///< the background side's border pixel repeated
  kNone,        ///< left black
  kInpaint,     ///< continued from the background around them in all directions
  kTexture,     ///< patches of the background copied into them: its texture goes on
  kInterpolate  ///< means of the background around them, weighted by distance
};

/// How colour is transferred to the new view after the forward mapping of disparities.
enum class WarpColour {
  kOnePass,  ///< fetched backward from the source image, one bicubic interpolation (3.2.7)
  kForward   ///< the source pixel moved to the nearest position: the book's method
};

/// Whether holes are filled when all rows of a view are complete.
inline bool needs_whole_image(HoleFilling holes) {
  return holes == HoleFilling::kInpaint || holes == HoleFilling::kTexture;
}

struct SynthesisOptions {
  WarpColour warp = WarpColour::kOnePass;
  HoleFilling holes = HoleFilling::kInterpolate;
  /// γ of (3.12), 0..1: blends the brightness of the two cameras (1 = left). Empty: γ = α, so that
  /// a view at a camera's position has the brightness of its photograph.
  std::optional<double> gamma = std::nullopt;
  /// Neighbours whose disparities differ by at most this are one surface; ≥ 0, in pixels.
  double disparity_gradient_limit_px = 1.0;
  /// Regress the right image's intensities on the left's (3.9–3.11); off: a = 0, b = 1.
  bool match_intensities = true;
  /// Soft outlines like a photograph's: pixels next to them that are mixtures of two surfaces weigh
  /// less than clean ones, and the surfaces on both sides are mixed over a pixel
  /// (kernels/soft_edges). Off: surfaces meet without a transition.
  bool soft_edges = true;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

}  // namespace vantage
