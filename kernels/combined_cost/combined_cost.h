#pragma once

#include <array>
#include <cstdint>

#include "kernels/census/census.h"
#include "kernels/feature_pairs.h"

namespace vantage::kernels {

// The cost of photographs: several terms, each a contaminated Gaussian (6.26 ff.) of one residual r
// of a pixel and its partner. Energy: Σ −log p, likelihood: Π p, p = (1−ε) exp(−r²/2σ²) + ε.
//
// No exponential and no logarithm is taken per cell. Residuals are counted in 64 steps, and what a
// step is worth is looked up in tables of 16-bit values, 32 cells at a time. Everything up to there
// is integer arithmetic, so cells are identical on every instruction set.

/// Grey levels and gradients are 16-bit: (value + offset) · kFixedPerLevel, rounded, those outside
/// clamped. The offsets leave room for levels that were changed to match another camera's.
inline constexpr int kFixedPerLevel = 32;
inline constexpr int kFixedLevelOffset = 128;     ///< −128..383 grey levels
inline constexpr int kFixedGradientOffset = 512;  ///< ±511 grey levels per pixel
inline constexpr int kMostFixed = 511 * kFixedPerLevel;
inline constexpr int kMostFixedGradient = 1023 * kFixedPerLevel;

/// Steps of a residual; those beyond the last one count as the last one.
inline constexpr int kResidualSteps = 64;

/// What a term is worth at each step: 16-bit values in two bytes.
struct TermTable {
  alignas(16) std::array<std::uint8_t, kResidualSteps> low{};
  alignas(16) std::array<std::uint8_t, kResidualSteps> high{};
};

/// One term: its step is (residual · multiplier) / 2^16.
struct CombinedTerm {
  std::uint16_t multiplier = 0;  ///< of the census, whose bits are the steps, not used
  TermTable table;
};

/// What cells hold. Values of tables are energies in units of 1/kEnergyUnitsPerNat, or likelihoods
/// as the upper halves of floats (8 significant bits).
enum class CombinedCells { kEnergy, kLikelihood };
inline constexpr int kEnergyUnitsPerNat = 512;

struct CombinedModel {
  CombinedTerm grey;      ///< Birchfield and Tomasi's difference, the mean of the channels
  CombinedTerm census;    ///< share of bits that differ
  CombinedTerm gradient;  ///< |Δgx| + |Δgy|
  bool has_census = false;
  bool has_gradient = false;
};

/// σ of each term; census and gradient: 0 leaves the term out.
struct CombinedSigmas {
  double grey_levels = 5;
  double census_share = 0;        ///< of the bits
  double gradient_levels_px = 0;  ///< grey levels per pixel
};

/// The least ε that counts: three of them are still a normal float.
inline constexpr double kLeastCombinedEpsilon = 1e-12;

/// Grey steps reach to where the Gaussian is a sixteenth of ε, so one is 0.05 to 0.1 σ (never less
/// than 1/32 grey level). σ > 0, ε in (0, 1); channels: 1 or 3 of the grey term.
CombinedModel combined_model(const CombinedSigmas& sigmas, double epsilon, int channels,
                             CombinedCells cells);

/// Planes: 16-bit grey levels, their least and largest values within half a pixel.
using FixedLevelPairs = FeaturePairs<std::uint16_t, 3>;
/// Planes: 16-bit gx and gy. One channel.
using FixedGradientPairs = FeaturePairs<std::uint16_t, 2>;

/// Rows of equal shape; `codes` and `gradients` only where the model has their terms, and of one
/// channel.
struct CombinedRow {
  FixedLevelPairs levels;
  CensusPairs codes;
  FixedGradientPairs gradients;
};

/// Writes columns × lanes floats. Energies are multiples of 1/512; lanes from count on are finite.
/// Likelihoods are 0 there.
void combined_row(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
                  float* cells);
void combined_row_ref(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
                      float* cells);

}  // namespace vantage::kernels
