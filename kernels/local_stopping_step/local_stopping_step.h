#pragma once

#include "kernels/star_row.h"

namespace vantage::kernels {

/// How certain the winner of a cell column is.
enum class CertaintyMeasure {
  kMargin,   ///< (Emin2 − Emin) / Σ E, 0 when Σ E = 0 (6.13); one candidate: 0
  kEntropy,  ///< Σ p log p ≤ 0, p ∝ exp(−scale · (E − Emin)) (6.15)
};

/// One row of diffusion with local stopping (6.4): a column whose certainty the step would lower
/// keeps its cells. Certainties travel with the columns: those of the input have it in float
/// `star.lanes` (star.pitch = lanes + kCertaintyFloats), except before the first iteration
/// (star.pitch = lanes), when it is computed.
struct LocalStoppingRow {
  StarRow star;
  float step = 0.15F;
  CertaintyMeasure measure = CertaintyMeasure::kMargin;
  float scale = 1;  ///< of the entropy, 1/(2σM²)
  int count = 0;    ///< candidates: lanes [0, count); the others do not count for certainty
  float* output = nullptr;
  int output_pitch = 0;  ///< lanes + kCertaintyFloats, or lanes: leaves the certainty out
};

/// Floats behind the lanes of a column that carries its certainty: one cache line.
inline constexpr int kCertaintyFloats = 16;

void local_stopping_row(const LocalStoppingRow& row);

/// The same, plainly: the diffusion in float in the same order, certainties in double.
void local_stopping_row_ref(const LocalStoppingRow& row);

}  // namespace vantage::kernels
