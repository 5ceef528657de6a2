#pragma once

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/stage_cost.h"
#include "engine/matching/options/match_options.h"
#include "kernels/evidence_sum/evidence_sum.h"

namespace vantage {

/// A rectangle of pixels, half-open.
struct PixelBlock {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
};

/// Displacement between the images of a pair: position in the left image minus position in the
/// right one, pixels. x is the disparity.
struct Displacement {
  int x_px = 0;
  int y_px = 0;
  friend bool operator==(Displacement, Displacement) = default;
};

/// Gradients of both images of a pair, for summing the evidence for displacements (5.5). Thread
/// rule: sums may be computed concurrently.
class EvidencePair {
 public:
  /// Uses luma and the gradient parameters of `parameters`. Throws UsageError when these are
  /// invalid, Error when sizes differ. Identical for any `execution`.
  EvidencePair(const Photograph& left, const Photograph& right, MethodParameters parameters,
               Execution& execution);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Σ E over the pixels of a block of the reference image whose partner lies inside the other one;
  /// others count 0. The order of summation depends on the block alone.
  [[nodiscard]] double evidence(Side reference, const PixelBlock& block,
                                Displacement displacement) const;
  /// Σ |g| over a block: the value of evidence() for a perfect match.
  [[nodiscard]] double contrast(Side reference, const PixelBlock& block) const;

 private:
  [[nodiscard]] double sum(const CostImage& reference, const CostImage& partner,
                           const PixelBlock& block, int partner_dx, int partner_dy) const;

  int width_;
  int height_;
  kernels::EvidenceNorm norm_;
  CostImage left_;
  CostImage right_;
};

}  // namespace vantage
