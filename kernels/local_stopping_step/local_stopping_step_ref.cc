#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/local_stopping_step/local_stopping_step.h"

namespace vantage::kernels {
namespace {

float winner_margin(const float* cells, int count) {
  if (count < 2) {
    return 0;
  }
  const float* const best = std::min_element(cells, cells + count);
  float second = best == cells ? cells[1] : cells[0];
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    sum += cells[i];
    if (cells + i != best) {
      second = std::min(second, cells[i]);
    }
  }
  return sum == 0 ? 0 : static_cast<float>((static_cast<double>(second) - *best) / sum);
}

float negative_entropy(const float* cells, int count, float scale) {
  const float* const best = std::min_element(cells, cells + count);
  double others = 0;  // without the winner, whose weight is 1
  double moment = 0;
  for (int i = 0; i < count; ++i) {
    const double exponent = std::min(
        static_cast<double>(scale) * (static_cast<double>(cells[i]) - *best), kMaxCertaintyNats);
    others += cells + i == best ? 0 : std::exp(-exponent);
    moment += std::exp(-exponent) * exponent;
  }
  return static_cast<float>(-moment / (1 + others) - std::log1p(others));
}

}  // namespace

void local_stopping_row_ref(const LocalStoppingRow& row) {
  const StarRow& star = row.star;
  const float own = 1.0F - 4.0F * row.step;
  const auto certainty = [&row](const float* cells) {
    return row.measure == CertaintyMeasure::kMargin ? winner_margin(cells, row.count)
                                                    : negative_entropy(cells, row.count, row.scale);
  };
  for (int x = 0; x < star.columns; ++x) {
    const float* const centre = star.centre + x * star.pitch;
    float* const output = row.output + static_cast<std::ptrdiff_t>(x) * row.output_pitch;
    const float before = star.pitch > star.lanes ? centre[star.lanes] : certainty(centre);
    for (int i = 0; i < star.lanes; ++i) {
      const float left = star.left_of(x)[i];
      const float right = star.right_of(x)[i];
      const float up = star.up[x * star.up_pitch + i];
      const float down = star.down[x * star.down_pitch + i];
      if (row.weights.are_given()) {
        const StarSteps steps = StarSteps::of(row.weights, row.step, x);
        output[i] = (1.0F - steps.sum()) * centre[i] + ((steps.left * left + steps.right * right) +
                                                        (steps.up * up + steps.down * down));
      } else {
        output[i] = own * centre[i] + row.step * ((left + right) + (up + down));
      }
    }
    float after = certainty(output);
    if (before > after) {
      std::copy_n(centre, star.lanes, output);
      after = before;
    }
    if (row.output_pitch > star.lanes) {
      std::fill_n(output + star.lanes, kCertaintyFloats, after);
    }
  }
}

}  // namespace vantage::kernels
