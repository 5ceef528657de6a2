#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/bayes_step/bayes_step.h"

namespace vantage::kernels {
namespace {

/// Normalises p, smooths it along the column and writes the state.
void finish_column(const BayesRow& row, std::vector<double>& p, float* output) {
  double sum = 0;
  for (const double value : p) {
    sum += value;
  }
  for (double& value : p) {
    value /= sum;
  }
  for (int i = 0; i < row.star.lanes; ++i) {
    if (row.state == BayesState::kProbability) {
      output[i] = static_cast<float>(p[static_cast<std::size_t>(i)]);
      continue;
    }
    double smoothed = row.prior.floor;
    for (int k = -row.prior.radius; k <= row.prior.radius; ++k) {
      if (i + k >= 0 && i + k < row.count) {
        smoothed += row.prior.taps[std::abs(k)] * p[static_cast<std::size_t>(i + k)];
      }
    }
    output[i] = static_cast<float>(
        row.state == BayesState::kSmoothed ? smoothed : row.mu * std::log(smoothed));
  }
}

/// p(lane) = p0 · weight(cells of the star), column by column.
template <class Weight>
void all_columns(const BayesRow& row, Weight weight) {
  const StarRow& star = row.star;
  std::vector<double> p(static_cast<std::size_t>(star.lanes));
  for (int x = 0; x < star.columns; ++x) {
    for (int i = 0; i < star.lanes; ++i) {
      p[static_cast<std::size_t>(i)] = star.source[x * star.lanes + i] * weight(x, i);
    }
    finish_column(row, p, row.output + x * star.lanes);
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
  const auto sum = [&star](int x, int i) {
    return static_cast<double>(star.centre[x * star.pitch + i]) + star.left_of(x)[i] +
           star.right_of(x)[i] + star.up[x * star.up_pitch + i] +
           star.down[x * star.down_pitch + i];
  };
  all_columns(row, [&](int x, int i) {
    // A factor that cancels, so that not all of a column can underflow.
    double largest = sum(x, 0);
    for (int k = 1; k < star.lanes; ++k) {
      largest = std::max(largest, sum(x, k));
    }
    return std::exp(sum(x, i) - largest);
  });
}

}  // namespace vantage::kernels
