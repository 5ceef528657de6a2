#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/cells/exp_log.h"
#include "kernels/feature_pairs.h"

namespace vantage::kernels {

// Costs per cell from the grey levels of a pixel and its partner (6.1); with three channels the
// mean of their costs. All functions write columns × lanes floats and are identical on every
// instruction set.

/// Planes: grey levels.
using GreyPairs = FeaturePairs<float, 1>;
/// Planes: grey levels, their minimum and maximum within half a pixel (sampling_bounds_row()).
using SampledPairs = FeaturePairs<float, 3>;

/// The measurement model (6.26 ff.): (1−ε) exp(−r²/2σ²) + ε.
struct ContaminatedGaussian {
  float exponent_scale = 0;  ///< factor of r²: −log2(e) / 2σ²
  float epsilon = 0;

  /// σ > 0 in grey levels, 0 < ε < 1. Both are clamped to the smallest value that floats can
  /// represent here (ε: 1e-30).
  static ContaminatedGaussian of(double sigma, double epsilon) {
    constexpr double kMaxScale = 1e30;
    constexpr double kMinEpsilon = 1e-30;
    const double scale = std::min(kMaxScale, 1 / (2 * sigma * sigma * std::log(2.0)));
    return {static_cast<float>(-scale), static_cast<float>(std::max(kMinEpsilon, epsilon))};
  }
  /// −log ε and ε: values of a cell without partner.
  [[nodiscard]] float energy_without_partner() const { return -log_of_normal(epsilon); }
  [[nodiscard]] float likelihood_without_partner() const { return epsilon; }
};

/// ΔI² (6.2).
void squared_row(const GreyPairs& row, float* cells);

/// min(|ΔI|, truncation); truncation may be infinite.
void absolute_row(const GreyPairs& row, float truncation, float* cells);

/// Birchfield–Tomasi difference: the minimum |ΔI| within half a pixel, between reference and
/// interpolated partner or vice versa, whichever is smaller.
void sampling_insensitive_row(const SampledPairs& row, float* cells);

/// −log of the measurement model at r² = ΔI². With three channels: the mean of their energies.
void contaminated_energy_row(const GreyPairs& row, ContaminatedGaussian model, float* cells);

/// The measurement model at r² = ΔI². With three channels: at the mean of their ΔI². Lanes ≥
/// row.count become 0.
void contaminated_likelihood_row(const GreyPairs& row, ContaminatedGaussian model, float* cells);

/// Existing cells, geometry.lanes() per column.
struct CellExtent {
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates
};

/// The measurement model at r = the cost in each cell, in place. Lanes ≥ row.count become 0.
void likelihood_of_costs(const CellExtent& row, ContaminatedGaussian model, float* cells);

/// exp(−energy) of each cell, in place: likelihoods of mean contaminated energies, ≥ 0 up to
/// rounding. Lanes ≥ row.count become 0.
void likelihood_of_energies(const CellExtent& row, float* cells);

/// Minimum and maximum grey level within half a pixel of each pixel, linearly interpolated. Columns
/// −1 and width are read. The outputs may be written up to the next multiple of kLaneMultiple; the
/// input is read one column farther.
void sampling_bounds_row(const float* grey, int width, float* min, float* max);

}  // namespace vantage::kernels
