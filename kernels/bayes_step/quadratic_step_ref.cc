#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/bayes_step/quadratic_step.h"

namespace vantage::kernels {
namespace {

double squared_distance(const QuadraticStepRow& row, int i, int j) {
  if (!row.plane.is_given()) {
    return std::pow(i - j, 2);
  }
  const int in_row = row.plane.row_candidates;
  return std::pow(i % in_row - j % in_row, 2) + std::pow(i / in_row - j / in_row, 2);
}

// logarithm(j): log₂ p.
template <class Logarithm>
double smoothed_logarithm(const QuadraticStepRow& row, int i, Logarithm logarithm) {
  const auto term = [&](int j) {
    return logarithm(j) - row.curvature * squared_distance(row, i, j);
  };
  double largest = term(i);
  for (int j = 0; j < row.count; ++j) {
    largest = std::max(largest, term(j));
  }
  if (row.largest_term) {
    return largest;
  }
  double sum = 0;
  for (int j = 0; j < row.count; ++j) {
    sum += std::exp2(term(j) - largest);
  }
  return largest + std::log2(sum);
}

// sum(x, i): of the star.
template <class Sum>
void quadratic_columns(const QuadraticStepRow& row, Sum sum) {
  for (int x = 0; x < row.star.columns; ++x) {
    const auto unshifted = [&](int i) {
      const double likelihood =
          std::max(row.star.source[x * row.source_pitch + i], std::numeric_limits<float>::min());
      return std::log2(likelihood) + sum(x, i);
    };
    double max = unshifted(0);
    for (int i = 1; i < row.count; ++i) {
      max = std::max(max, unshifted(i));
    }
    const auto logarithm = [&](int i) {
      return std::max(unshifted(i) - max, double{kLowestLogarithm});
    };
    double total = 0;
    for (int i = 0; i < row.count; ++i) {
      total += std::exp2(logarithm(i));
    }
    float* const output = row.output + x * row.output_pitch;
    std::fill_n(output, row.star.lanes, 0.0F);
    for (int i = 0; i < row.count; ++i) {
      output[i] = static_cast<float>(row.smooths ? row.mu * smoothed_logarithm(row, i, logarithm)
                                                 : std::exp2(logarithm(i)) / total);
    }
  }
}

}  // namespace

void quadratic_start_row_ref(const QuadraticStepRow& row) {
  quadratic_columns(row, [](int, int) { return 0.0; });
}

void quadratic_step_row_ref(const QuadraticStepRow& row) {
  const StarRow& star = row.star;
  const auto weight = [&row](const float* weights, int x) {
    return row.weights.are_given() ? double{weights[x]} : 1.0;
  };
  quadratic_columns(row, [&](int x, int i) {
    return star.centre[x * star.pitch + i] + weight(row.weights.beside, x) * star.left_of(x)[i] +
           weight(row.weights.beside, x + 1) * star.right_of(x)[i] +
           weight(row.weights.above, x) * star.up[x * star.up_pitch + i] +
           weight(row.weights.below, x) * star.down[x * star.down_pitch + i];
  });
}

}  // namespace vantage::kernels
