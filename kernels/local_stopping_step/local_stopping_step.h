#pragma once

#include "kernels/cells/exp_log.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

/// Certainty measure for the winner of a cell column.
enum class CertaintyMeasure {
  kMargin,  ///< (Emin2 − Emin) / Σ E, 0 when Σ E = 0 (6.13); one candidate: 0
  /// Σ p log p ≤ 0, p ∝ exp(−min(scale · (E − Emin), kMaxCertaintyNats)) (6.15). Its *relative*
  /// error is small, however close it is to 0, so that columns with a sure winner are compared by
  /// their certainties, not by rounding errors.
  kEntropy,
};

/// The largest exponent that counts: exp(−kMaxCertaintyNats) = 2^kMinExponent is a normal float.
inline constexpr double kMaxCertaintyNats = -double{kMinExponent} / kLog2E;

/// One row of diffusion with local stopping (6.4): a column keeps its cells if the step would lower
/// its certainty. The step is that of DiffusionRow without a pull. Certainties are stored with the
/// columns: input columns have it in float `star.lanes` (star.pitch = lanes + kCertaintyFloats),
/// except before the first iteration (star.pitch = lanes), when it is computed.
struct LocalStoppingRow {
  StarRow star;
  float step = 0.15F;
  StarWeights weights = {};  ///< of the neighbours; absent: all are 1
  CertaintyMeasure measure = CertaintyMeasure::kMargin;
  float scale = 1;  ///< for the entropy
  int count = 0;    ///< candidates: lanes [0, count); other lanes do not affect certainty
  float* output = nullptr;
  int output_pitch = 0;  ///< lanes + kCertaintyFloats; or lanes: certainty is not stored
};

/// Floats after the lanes of a column that stores its certainty: one cache line.
inline constexpr int kCertaintyFloats = 16;

void local_stopping_row(const LocalStoppingRow& row);

/// Scalar reference: diffusion in float in the same order, certainties in double.
void local_stopping_row_ref(const LocalStoppingRow& row);

}  // namespace vantage::kernels
