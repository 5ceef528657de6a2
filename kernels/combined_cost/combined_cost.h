#pragma once

#include <array>
#include <cstdint>

#include "kernels/census/census.h"
#include "kernels/feature_pairs.h"

namespace vantage::kernels {

// A cost for photographs: several terms, each a contaminated Gaussian (6.26 ff.) of one residual r
// of a pixel and its partner. Energy: Σ −log p, likelihood: Π p, p = (1−ε) exp(−r²/2σ²) + ε.
//
// No exponential or logarithm is evaluated per cell. Residuals are quantised to 64 steps; the value
// of a step is looked up in tables of 16-bit values, 32 cells at a time. Everything before the
// lookup is integer arithmetic, so cells are identical on every instruction set.

/// Grey levels and gradients are 16-bit: (value + offset) · kFixedPerIntensity, rounded and
/// clamped. The offsets leave room for grey levels that were adjusted to match another camera's.
inline constexpr int kFixedPerIntensity = 32;
inline constexpr int kFixedIntensityOffset = 128;  ///< −128..383 grey levels
inline constexpr int kFixedGradientOffset = 512;   ///< ±511 grey levels per pixel
inline constexpr int kMaxFixed = 511 * kFixedPerIntensity;
inline constexpr int kMaxFixedGradient = 1023 * kFixedPerIntensity;

/// Steps of a residual; residuals beyond the last step are clamped to it.
inline constexpr int kResidualSteps = 64;

/// Value of a term at each step: 16-bit values as two bytes.
struct TermTable {
  alignas(16) std::array<std::uint8_t, kResidualSteps> low{};
  alignas(16) std::array<std::uint8_t, kResidualSteps> high{};
};

/// One term; its step is (residual · multiplier) / 2^16.
struct CombinedTerm {
  std::uint16_t multiplier = 0;  ///< unused for census, whose bits are the steps
  TermTable table;
};

/// Contents of cells. Table values are energies in units of 1/kEnergyUnitsPerNat, or likelihoods as
/// the upper halves of floats (8 significant bits).
enum class CombinedCells { kEnergy, kLikelihood };
inline constexpr int kEnergyUnitsPerNat = 512;

struct CombinedModel {
  CombinedTerm grey;      ///< Birchfield–Tomasi difference, mean over the channels
  CombinedTerm census;    ///< fraction of differing bits
  CombinedTerm gradient;  ///< |Δgx| + |Δgy|
  bool has_census = false;
  bool has_gradient = false;
};

/// σ of each term. census_share and gradient_levels_px: 0 omits the term.
struct CombinedSigmas {
  double grey_levels = 5;
  double census_share = 0;        ///< fraction of the bits
  double gradient_levels_px = 0;  ///< grey levels per pixel
};

/// Smallest ε in use: its cube is still a normal float.
inline constexpr double kMinCombinedEpsilon = 1e-12;

/// Grey steps extend to where the Gaussian is a sixteenth of ε, so a step is 0.05 to 0.1 σ (at
/// least 1/32 grey level). σ > 0, ε in (0, 1); channels: 1 or 3, for the grey term.
CombinedModel combined_model(const CombinedSigmas& sigmas, double epsilon, int channels,
                             CombinedCells cells);

/// Planes: 16-bit grey levels, their minimum and maximum within half a pixel.
using FixedIntensityPairs = FeaturePairs<std::uint16_t, 3>;
/// Planes: 16-bit gx and gy. One channel.
using FixedGradientPairs = FeaturePairs<std::uint16_t, 2>;

/// Rows of equal shape. `codes` and `gradients` are used only if the model has their terms, and
/// have one channel.
struct CombinedRow {
  FixedIntensityPairs levels;
  CensusPairs codes;
  FixedGradientPairs gradients;
};

/// Writes columns × lanes floats. Energies are multiples of 1/512. In lanes ≥ count energies are
/// finite and likelihoods are 0.
void combined_row(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
                  float* cells);

}  // namespace vantage::kernels
