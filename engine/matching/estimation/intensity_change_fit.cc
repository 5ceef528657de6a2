#include "engine/matching/estimation/intensity_change_fit.h"

#include <algorithm>
#include <cmath>

#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr int kRounds = 20;
/// Residuals beyond this many σ have zero weight (95 % efficiency for Gaussian noise).
constexpr double kBiweightReach = 4.685;
constexpr double kMinResidualSigma = 1;
constexpr double kMinContrast = 2;  ///< standard deviation, grey levels
constexpr double kLargestGain = 4;
constexpr double kMinShare = 0.5;  ///< of the pairs: total weight on the line
constexpr double kMinCorrelation = 0.7;

/// Weighted moments.
struct Moments {
  double weight = 0;
  double mean_reference = 0;
  double mean_other = 0;
  double reference_reference = 0;  ///< about the means
  double other_other = 0;
  double reference_other = 0;
};

/// weight_of(pair) ≥ 0.
template <typename Weight>
Moments moments_of(std::span<const IntensityPair> pairs, const Weight& weight_of) {
  Moments sums;
  for (const IntensityPair& pair : pairs) {
    const double weight = weight_of(pair);
    const double a = pair.reference;
    const double b = pair.other;
    sums.weight += weight;
    sums.mean_reference += weight * a;
    sums.mean_other += weight * b;
    sums.reference_reference += weight * a * a;
    sums.other_other += weight * b * b;
    sums.reference_other += weight * a * b;
  }
  if (sums.weight > 0) {
    sums.mean_reference /= sums.weight;
    sums.mean_other /= sums.weight;
    sums.reference_reference =
        sums.reference_reference / sums.weight - sums.mean_reference * sums.mean_reference;
    sums.other_other = sums.other_other / sums.weight - sums.mean_other * sums.mean_other;
    sums.reference_other =
        sums.reference_other / sums.weight - sums.mean_reference * sums.mean_other;
  }
  return sums;
}

std::optional<IntensityChange> line_of(const Moments& moments) {
  const double contrast = kMinContrast * kMinContrast;
  if (!(moments.reference_reference >= contrast && moments.other_other >= contrast)) {
    return std::nullopt;
  }
  const double gain = std::sqrt(moments.reference_reference / moments.other_other);
  return IntensityChange{.gain = gain,
                         .offset = moments.mean_reference - gain * moments.mean_other};
}

double residual(const IntensityPair& pair, const IntensityChange& line) {
  return pair.reference - (line.gain * pair.other + line.offset);
}

}  // namespace

double robust_sigma(std::span<float> residuals) {
  constexpr double kOfMedian = 1.4826;
  return kOfMedian * static_cast<double>(upper_median(residuals));
}

double noise_sigma(std::span<float> residuals) {
  constexpr double kSigmas = 1.6449;  // 90 % quantile of a unit Gaussian's magnitudes
  return static_cast<double>(value_of_rank(residuals, residuals.size() * 9 / 10)) / kSigmas;
}

std::optional<IntensityChange> fit_intensity_change(std::span<const IntensityPair> pairs) {
  if (pairs.size() < kMinIntensityPairs) {
    return std::nullopt;
  }
  std::optional<IntensityChange> line =
      line_of(moments_of(pairs, [](const IntensityPair& /*pair*/) { return 1.0; }));
  std::vector<float> residuals(pairs.size());
  Moments moments;
  for (int round = 0; round < kRounds && line; ++round) {
    std::ranges::transform(pairs, residuals.begin(), [&](const IntensityPair& pair) {
      return static_cast<float>(std::abs(residual(pair, *line)));
    });
    const double reach = kBiweightReach * std::max(kMinResidualSigma, robust_sigma(residuals));
    moments = moments_of(pairs, [&](const IntensityPair& pair) {
      const double share = residual(pair, *line) / reach;
      const double left = std::max(0.0, 1 - share * share);
      return left * left;
    });
    line = line_of(moments);
  }
  if (!line || !(line->gain >= 1 / kLargestGain && line->gain <= kLargestGain) ||
      moments.weight < kMinShare * static_cast<double>(pairs.size()) ||
      moments.reference_other <
          kMinCorrelation * std::sqrt(moments.reference_reference * moments.other_other)) {
    return std::nullopt;
  }
  return line;
}

}  // namespace vantage
