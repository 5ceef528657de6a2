#pragma once

#include "kernels/candidates.h"
#include "kernels/evidence/gradient_norm.h"
#include "kernels/feature_pairs.h"

namespace vantage::kernels {

/// Planes: α·gx, α·gy and |g|/2 of each pixel's gradient g.
using GradientPairs = FeaturePairs<float, 3>;

/// A row of gradients, converted to those planes. On input x and y hold gx and gy.
struct GradientRowPlanes {
  float* x = nullptr;
  float* y = nullptr;
  float* half_norm = nullptr;
  int width = 0;
};

/// Fills half_norm and multiplies x and y by α, in place. All three are read and written up to the
/// first multiple of kLaneMultiple ≥ `width`. Identical on every instruction set.
void evidence_planes_row(const GradientRowPlanes& row, float alpha, EvidenceNorm norm);

/// Negated evidence for a match (5.5): α |gL − gR| − (|gL| + |gR|)/2, where |·| is the norm.
/// With three channels: the mean. Writes columns × lanes floats. Identical on every
/// instruction set.
void negated_evidence_row(const GradientPairs& row, EvidenceNorm norm, float* cells);

/// Cells of negated evidence, geometry.lanes() per column.
struct EvidenceRow {
  CandidateGeometry geometry;
  int first_column = 0;
  int columns = 0;
};

/// Smallest σ for which differences of evidence divided by σ stay finite.
inline constexpr double kMinEvidenceSigma = 1e-30;

/// In place: (1−ε) exp((E − max E) / σ) + ε, with the maximum over the column's candidates with a
/// partner; ε for those without, 0 in the lanes after them. σ in (0, ∞), ε in (0, 1).
void likelihood_of_evidence(const EvidenceRow& row, float sigma, float epsilon, float* cells);

}  // namespace vantage::kernels
