#include "kernels/bayes_step/quadratic_step.h"

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels::quadratic_step_test {

using Kernel = void (*)(const QuadraticStepRow&);

struct Shape {
  int columns;
  int count;
};
constexpr Shape kShapes[] = {{1, 1}, {2, 3}, {3, 16}, {5, 17}, {4, 64}, {2, 113}, {1, 300}};

/// What differs between rows of one shape.
struct Case {
  float curvature;
  bool largest_term;
  bool smooths;
};

class QuadraticStep : public EveryTarget {
 protected:
  /// Compares a kernel with its reference on random rows whose cells reach down to `low`.
  static void compare(Kernel kernel, Kernel reference, float low, bool is_weighted,
                      bool is_in_plane) {
    unsigned seed = 1;
    for (const Shape shape : kShapes) {
      for (const float curvature : {0.0F, 0.004F, 1.0F, 72.0F, 1e20F}) {
        for (const bool largest_term : {false, true}) {
          for (const bool smooths : {false, true}) {
            compare_rows(kernel, reference, shape, {curvature, largest_term, smooths}, low,
                         is_weighted, is_in_plane, ++seed);
          }
        }
      }
    }
  }

 private:
  static void compare_rows(Kernel kernel, Kernel reference, Shape shape, Case of, float low,
                           bool is_weighted, bool is_in_plane, unsigned seed) {
    const int lanes = CandidateGeometry{1, 0, shape.count, -1}.lanes();
    StarRows rows(shape.columns, lanes, lanes, low, 0, seed);
    for (int i = 0; i < shape.columns * lanes; ++i) {
      // 0 where float likelihoods have underflowed, and in padding.
      rows.source()[i] =
          i % lanes < shape.count && i % 5 != 0 ? 0.01F * static_cast<float>(i % 7) : 0.0F;
    }
    if (seed % 2 == 0) {
      rows.remove_up(0);
    }
    const RandomStarWeights weights(shape.columns, seed);
    QuadraticStepRow row;
    row.star = rows.star();
    row.curvature = of.curvature;
    row.largest_term = of.largest_term;
    row.smooths = of.smooths;
    row.mu = 0.7F;
    row.weights = is_weighted ? weights.star() : StarWeights{};
    row.count = shape.count;
    row.source_pitch = lanes;
    row.output_pitch = lanes + static_cast<int>(seed % 3) * kLaneMultiple;
    row.plane = is_in_plane ? plane_of(shape.count, seed) : CandidatePlane{};
    Image<float> work(quadratic_work_floats(lanes, row.plane), 1);
    work.fill(-7);  // any contents
    row.work = work.row(0);
    const int width = static_cast<int>(row.output_pitch) * shape.columns;
    Image<float> expected(width, 1);
    Image<float> actual(width, 1);
    expected.fill(5);  // what lies between columns stays
    actual.fill(5);
    row.output = expected.row(0);
    reference(row);
    row.output = actual.row(0);
    kernel(row);
    for (int i = 0; i < width; ++i) {
      // Of logarithms: the rounding of sums of numbers down to `low`.
      const double bound =
          1e-6 * (1 + std::abs(expected.at(i, 0)) + (of.smooths ? 0.0 : 1.0)) - 1e-6 * low;
      ASSERT_NEAR(actual.at(i, 0), expected.at(i, 0), bound)
          << shape.columns << " columns of " << shape.count << ", curvature " << of.curvature
          << ", largest " << of.largest_term << ", smooths " << of.smooths << ", cell " << i;
    }
  }
};

TEST_P(QuadraticStep, StartEqualsReference) {
  compare(quadratic_start_row, quadratic_start_row_ref, -1, false, false);
  compare(quadratic_start_row, quadratic_start_row_ref, -1, false, true);
}

TEST_P(QuadraticStep, EqualsReference) {
  compare(quadratic_step_row, quadratic_step_row_ref, -8, false, false);
  compare(quadratic_step_row, quadratic_step_row_ref, -8, true, true);
}

TEST_P(QuadraticStep, SurvivesEnergiesFarBeyondTheRangeOfExponentials) {
  compare(quadratic_step_row, quadratic_step_row_ref, -3000, true, false);
  compare(quadratic_step_row, quadratic_step_row_ref, -3000, false, true);
}

TEST(QuadraticStepTargets, HaveTheSameBits) {
  const int lanes = 64;
  StarRows rows(3, lanes, lanes, -40, 0, 5);
  for (int i = 0; i < 3 * lanes; ++i) {
    rows.source()[i] = 0.001F * static_cast<float>(1 + i % 31);
  }
  const RandomStarWeights weights(3, 5);
  QuadraticStepRow row;
  row.star = rows.star();
  row.curvature = 0.3F;
  row.weights = weights.star();
  row.count = 60;
  row.source_pitch = row.output_pitch = lanes;
  Image<float> work(quadratic_work_floats(lanes), 1);
  row.work = work.row(0);
  std::vector<float> first;
  for (const long long target : each_target()) {
    force_target(target);
    Image<float> output(3 * lanes, 1);
    row.output = output.row(0);
    quadratic_step_row(row);
    const std::vector<float> cells(output.row(0), output.row(0) + 3 * lanes);
    if (first.empty()) {
      first = cells;
    }
    EXPECT_EQ(cells, first) << target_name(target);
  }
  force_target(0);
}

VANTAGE_EVERY_TARGET_OF(QuadraticStep);

}  // namespace vantage::kernels::quadratic_step_test
