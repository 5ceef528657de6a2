#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "kernels/combined_cost/combined_cost.h"

namespace vantage::kernels {
namespace {

/// Residuals are resolved up to where the Gaussian is this fraction of ε.
constexpr double kSmallestPart = 1.0 / 16;

double measurement(double residual_sigmas, double epsilon) {
  return (1 - epsilon) * std::exp(-residual_sigmas * residual_sigmas / 2) + epsilon;
}

/// In units of σ.
double max_residual(double epsilon) {
  const double ratio = (1 - epsilon) / (epsilon * kSmallestPart);
  return std::sqrt(2 * std::max(2.0, std::log(ratio)));
}

std::uint32_t table_value(double likelihood, CombinedCells cells) {
  if (cells == CombinedCells::kEnergy) {
    return static_cast<std::uint32_t>(std::lround(-std::log(likelihood) * kEnergyUnitsPerNat));
  }
  constexpr std::uint32_t kHalf = 0x8000;
  return (std::bit_cast<std::uint32_t>(static_cast<float>(likelihood)) + kHalf) >> 16U;
}

/// residual_of(step): in units of σ.
template <typename ResidualOfStep>
TermTable term_table(double epsilon, CombinedCells cells, const ResidualOfStep& residual_of) {
  TermTable table;
  for (int step = 0; step < kResidualSteps; ++step) {
    const std::uint32_t value = table_value(measurement(residual_of(step), epsilon), cells);
    table.low[static_cast<std::size_t>(step)] = static_cast<std::uint8_t>(value & 0xFFU);
    table.high[static_cast<std::size_t>(step)] = static_cast<std::uint8_t>(value >> 8U);
  }
  return table;
}

/// `sigma`: in units of the fixed-point residual.
CombinedTerm fixed_term(double sigma, double epsilon, CombinedCells cells) {
  constexpr double kOne = 65536;
  CombinedTerm term;
  const double multiplier = kResidualSteps * kOne / (max_residual(epsilon) * sigma);
  term.multiplier = static_cast<std::uint16_t>(std::clamp(multiplier, 1.0, kOne - 1));
  term.table = term_table(epsilon, cells, [&](int step) {
    // Midpoint of the integer residuals in this step.
    const double first = std::ceil(step * kOne / term.multiplier);
    const double end = std::ceil((step + 1) * kOne / term.multiplier);
    return (first + end - 1) / 2 / sigma;
  });
  return term;
}

}  // namespace

CombinedModel combined_model(const CombinedSigmas& sigmas, double epsilon, int channels,
                             CombinedCells cells) {
  constexpr double kMinSigma = 1e-30;
  epsilon = std::max(kMinCombinedEpsilon, epsilon);
  CombinedModel model;
  model.grey = fixed_term(std::max(kMinSigma, sigmas.grey_levels * kFixedPerIntensity * channels),
                          epsilon, cells);
  model.has_census = sigmas.census_share > 0;
  if (model.has_census) {
    model.census.table = term_table(epsilon, cells, [&](int bits) {
      return static_cast<double>(bits) / kCensusBits / sigmas.census_share;
    });
  }
  model.has_gradient = sigmas.gradient_levels_px > 0;
  if (model.has_gradient) {
    model.gradient = fixed_term(sigmas.gradient_levels_px * kFixedPerIntensity, epsilon, cells);
  }
  return model;
}

}  // namespace vantage::kernels
