#include "engine/matching/volume/posterior_moments.h"

#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/image/left_out.h"

namespace vantage {
namespace {

struct Moments {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double variance = std::numeric_limits<double>::quiet_NaN();
};

Moments moments_of(const VolumeShape& shape, const float* probabilities) {
  const int candidates = shape.candidates();
  const double step_px = 1.0 / shape.steps_per_px;
  double total = 0;
  double first = 0;
  for (int i = 0; i < candidates; ++i) {
    const auto p = static_cast<double>(probabilities[i]);
    if (p > 0) {
      total += p;
      first += p * i;
    }
  }
  if (total == 0) {
    return {};
  }
  const double mean = first / total;
  double second = 0;
  for (int i = 0; i < candidates; ++i) {
    const auto p = static_cast<double>(probabilities[i]);
    if (p > 0) {
      second += p * (i - mean) * (i - mean);
    }
  }
  return {shape.disparities.min + mean * step_px, second / total * step_px * step_px};
}

}  // namespace

void PosteriorMoments::start(const VolumeShape& shape) {
  if (shape.content != VolumeContent::kProbabilities) {
    throw UsageError("there are no probabilities, expected the aggregation bayes");
  }
  if (shape.disparities_y) {
    throw UsageError("there are probabilities of displacements, expected a search along rows only");
  }
  shape_ = shape;
  mean_px_.resize(shape.width_px, shape.height_px);
  variance_px2_.resize(shape.width_px, shape.height_px);
}

void PosteriorMoments::write(int x, int y, int columns, const float* values) {
  for (int j = 0; j < columns; ++j, values += shape_.candidates()) {
    const Moments moments = moments_of(shape_, values);
    mean_px_.at(x + j, y) = static_cast<float>(moments.mean);
    variance_px2_.at(x + j, y) = static_cast<float>(moments.variance);
  }
}

void PosteriorMoments::erase(const Mask& left_out) {
  erase_left_out(left_out, mean_px_);
  erase_left_out(left_out, variance_px2_);
}

}  // namespace vantage
