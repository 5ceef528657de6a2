#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kernels/bayes_step/bayes_step.h"

namespace vantage::kernels {
namespace {

double state_of(const BayesRow& row, double smoothed) {
  return row.state == BayesState::kSmoothed ? smoothed : row.mu * std::log2(smoothed);
}

/// Weighted sum over the candidates around candidate i with the taps of both directions; candidates
/// outside the plane count 0.
template <class Probability>
double plane_sum(const BayesRow& row, int i, Probability p) {
  const CandidatePlane& plane = row.plane;
  double sum = 0;
  for (int j = 0; i < row.count && j < row.count; ++j) {
    const int across = std::abs(j % plane.row_candidates - i % plane.row_candidates);
    const int down = std::abs(j / plane.row_candidates - i / plane.row_candidates);
    if (across <= row.prior.radius && down <= row.prior.radius) {
      sum += double{row.prior.taps[across]} * row.prior.taps[down] / row.prior.taps[0] * p(j);
    }
  }
  return sum;
}

/// p(lane) = p0 · weight(x, lane), normalised, smoothed along the column and stored as the row's
/// state.
template <class Weight>
void make_column(const BayesRow& row, int x, Weight weight) {
  const float* const source = row.star.source + x * row.source_pitch;
  float* const output = row.output + x * row.output_pitch;
  double sum = 0;
  for (int i = 0; i < row.star.lanes; ++i) {
    sum += source[i] * weight(x, i);
  }
  const auto p = [&](int i) { return source[i] * weight(x, i) / sum; };
  for (int i = 0; i < row.star.lanes; ++i) {
    if (row.state == BayesState::kProbability) {
      output[i] = static_cast<float>(p(i));
      continue;
    }
    double smoothed = row.prior.floor;
    if (row.plane.is_given()) {
      output[i] = static_cast<float>(state_of(row, smoothed + plane_sum(row, i, p)));
      continue;
    }
    for (int k = -row.prior.radius; k <= row.prior.radius; ++k) {
      if (i + k >= 0 && i + k < row.count) {
        smoothed += row.prior.taps[std::abs(k)] * p(i + k);
      }
    }
    output[i] = static_cast<float>(state_of(row, smoothed));
  }
}

template <class Weight>
void all_columns(const BayesRow& row, Weight weight) {
  for (int x = 0; x < row.star.columns; ++x) {
    make_column(row, x, weight);
  }
}

}  // namespace

void bayes_start_row_ref(const BayesRow& row) {
  all_columns(row, [](int, int) { return 1.0; });
}

void bayes_half_row_ref(const BayesRow& row) {
  const StarRow& star = row.star;
  all_columns(row, [&star](int x, int i) {
    return std::sqrt(static_cast<double>(star.centre[x * star.pitch + i]) * star.left_of(x)[i] *
                     star.right_of(x)[i] * star.up[x * star.up_pitch + i] *
                     star.down[x * star.down_pitch + i]);
  });
}

void bayes_general_row_ref(const BayesRow& row) {
  const StarRow& star = row.star;
  const auto weight = [&row](const float* weights, int x) {
    return row.weights.are_given() ? static_cast<double>(weights[x]) : 1.0;
  };
  const auto sum = [&](int x, int i) {
    return star.centre[x * star.pitch + i] + weight(row.weights.beside, x) * star.left_of(x)[i] +
           weight(row.weights.beside, x + 1) * star.right_of(x)[i] +
           weight(row.weights.above, x) * star.up[x * star.up_pitch + i] +
           weight(row.weights.below, x) * star.down[x * star.down_pitch + i];
  };
  all_columns(row, [&](int x, int i) {
    // Subtracted from all lanes (it cancels), so that a column cannot underflow completely.
    double largest = sum(x, 0);
    for (int k = 1; k < star.lanes; ++k) {
      largest = std::max(largest, sum(x, k));
    }
    return std::exp2(sum(x, i) - largest);
  });
}

}  // namespace vantage::kernels
