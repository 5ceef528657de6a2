#include "engine/evaluation/disparity_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/matching/parameters/prior_penalty.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

class KeptSpace final : public VolumeSink {
 public:
  void start(const VolumeShape& shape) override { space.emplace(shape); }
  void write(int x, int y, int columns, const float* values) override {
    const VolumeShape& shape = space->shape();
    std::copy_n(
        values,
        static_cast<std::size_t>(columns) * static_cast<std::size_t>(shape.disparities.count()),
        &space->at(x, y, shape.disparities.min));
  }

  std::optional<DisparitySpace> space;
};

/// (6.33) and (6.34) of one column.
void smooth_column(const DisparitySpace& probabilities, const MethodParameters& parameters, int x,
                   int y, std::vector<double>& smoothed, std::vector<double>& energy) {
  const DisparityRange range = probabilities.shape().disparities;
  std::vector<double> weights;  // by offset + count - 1
  double sum = 0;
  for (int offset = 1 - range.count(); offset < range.count(); ++offset) {
    weights.push_back(std::exp(-prior_penalty(parameters, offset)));
    sum += weights.back();
  }
  smoothed.clear();
  energy.clear();
  for (int d = range.min; d <= range.max; ++d) {
    double value = 0;
    for (int other = range.min; other <= range.max; ++other) {
      value += weights[static_cast<std::size_t>(other - d + range.count() - 1)] / sum *
               double{probabilities.at(x, y, other)};
    }
    smoothed.push_back(value);
    energy.push_back(-std::log(value));
  }
}

}  // namespace

DisparitySpace::DisparitySpace(const VolumeShape& shape)
    : shape_(shape),
      values_(static_cast<std::size_t>(shape.width_px) * static_cast<std::size_t>(shape.height_px) *
                  static_cast<std::size_t>(shape.disparities.count()),
              std::numeric_limits<float>::quiet_NaN()) {}

DisparitySpace disparity_space(const BookPair& pair, MatchOptions options, VolumeKind kind,
                               Execution& execution) {
  options.disparities = pair.search;
  options.reference = Side::kLeft;
  KeptSpace kept;
  const std::array<VolumeRequest, 1> volumes = {
      {{.side = Side::kLeft, .kind = kind, .level = 0, .sink = &kept}}};
  DisparityMaps maps;
  StereoMatcher(options, execution)
      .match(pair.left, pair.right, {.right = false, .unmatched = false, .volumes = volumes}, maps);
  return std::move(kept.space.value());
}

BayesSteps bayes_steps(const DisparitySpace& costs, const DisparitySpace& probabilities,
                       const MethodParameters& parameters, int x, int y) {
  const DisparityRange range = costs.shape().disparities;
  BayesSteps steps;
  smooth_column(probabilities, parameters, x, y, steps.smoothed, steps.smoothed_energy);
  steps.energy.resize(steps.smoothed.size());
  for (std::size_t i = 0; i < steps.energy.size(); ++i) {
    steps.energy[i] = double{costs.at(x, y, range.min + static_cast<int>(i))} +
                      parameters.mu * steps.smoothed_energy[i];
  }
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    std::vector<double> smoothed;
    std::vector<double> energy;
    smooth_column(probabilities, parameters, x + dx, y + dy, smoothed, energy);
    for (std::size_t i = 0; i < steps.energy.size(); ++i) {
      steps.energy[i] += parameters.mu * energy[i];
    }
  }
  double sum = 0;
  for (const double energy : steps.energy) {
    steps.probability.push_back(std::exp(-energy));
    sum += steps.probability.back();
  }
  for (double& probability : steps.probability) {
    probability /= sum;
  }
  return steps;
}

}  // namespace vantage
