#pragma once

#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/evidence/gradient_norm.h"

namespace vantage::kernels {

/// Planes of an image's gradients g, starting at some pixel: α·gx, α·gy and |g|/2, as computed by
/// evidence_planes_row().
struct GradientBlock {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* half_norm = nullptr;
  std::ptrdiff_t row_stride = 0;  ///< floats between rows, in all planes
};

/// A rectangle of pixels of one image and the pixels of another image to compare it with. Rows must
/// be readable up to the first multiple of kLaneMultiple ≥ `columns`.
struct EvidenceBlock {
  GradientBlock reference;
  GradientBlock partner;
  int columns = 0;
  int rows = 0;
  EvidenceNorm norm = EvidenceNorm::kL2;  ///< of the difference
};

/// Σ over the block of E = (|gL| + |gR|)/2 − α |gL − gR| (5.5). E is float. Column j is added to
/// sum j mod kLaneMultiple, in float, from top to bottom; these sums are added pairwise in double.
/// For blocks of up to some 10⁴ pixels. Identical on every instruction set.
double evidence_sum(const EvidenceBlock& block);

/// Adds the sums of kLaneMultiple lanes, neighbouring halves first.
double pairwise_sum(const float* lanes);

}  // namespace vantage::kernels
