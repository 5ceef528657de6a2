#include "kernels/bayes_step/bayes_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels {
namespace {

using Kernel = void (*)(const BayesRow&);

struct Shape {
  int columns;
  int count;
};
constexpr Shape kShapes[] = {{1, 1},  {2, 3},  {3, 16},  {5, 17},  {1, 33}, {4, 64},
                             {3, 80}, {2, 96}, {2, 113}, {2, 128}, {1, 300}};

/// Runs of lanes: one, every kLaneMultiple lanes one, or a cut behind the first ones.
std::vector<int> segment_ends(int lanes, int kind) {
  std::vector<int> ends;
  for (int end = kLaneMultiple; kind > 0 && end < lanes; end += kLaneMultiple) {
    if (kind == 1 || ends.empty()) {
      ends.push_back(end);
    }
  }
  if (kind > 0) {
    ends.push_back(lanes);
  }
  return ends;
}

class BayesStep : public EveryTarget {
 protected:
  /// Compares a kernel with its reference on random rows; `low`, `high` bound the cells.
  static void compare(Kernel kernel, Kernel reference, float low, float high, float neutral,
                      double bound, float floor = 0.01F) {
    const std::vector<float> taps{0.99F, 0.3F, 0.04F};
    unsigned seed = 1;
    for (const Shape shape : kShapes) {
      for (int radius = 0; radius <= 2; ++radius) {
        for (const BayesState state :
             {BayesState::kSmoothed, BayesState::kLogSmoothed, BayesState::kProbability}) {
          const int lanes = CandidateGeometry{1, 0, shape.count, -1}.lanes();
          StarRows rows(shape.columns, lanes, lanes, low, high, ++seed);
          // Columns of the source and of the output need not lie one behind the other.
          const int source_pitch = lanes + static_cast<int>(seed % 2) * kLaneMultiple;
          const int output_pitch = lanes + static_cast<int>(seed % 3) * kLaneMultiple;
          Image<float> source(source_pitch * shape.columns, 1);
          for (int i = 0; i < source.width(); ++i) {
            const bool is_candidate = i % source_pitch < shape.count;
            source.at(i, 0) = is_candidate ? 0.1F + 0.01F * static_cast<float>(i % 7) : 0.0F;
          }
          if (seed % 2 == 0) {
            rows.remove_up(neutral);
          }
          BayesRow row;
          row.star = rows.star();
          row.star.source = source.row(0);
          row.source_pitch = source_pitch;
          row.output_pitch = output_pitch;
          const std::vector<int> ends = segment_ends(lanes, static_cast<int>(seed % 4));
          row.segment_ends = ends;
          row.prior = {taps.data(), radius, floor};
          row.state = state;
          row.mu = 0.7F;
          row.count = shape.count;
          Image<float> work(
              bayes_work_floats(lanes, radius, std::max(1, static_cast<int>(ends.size()))), 1);
          work.fill(-7);  // any contents
          row.work = work.row(0);
          Image<float> expected(output_pitch * shape.columns, 1);
          Image<float> actual(output_pitch * shape.columns, 1);
          expected.fill(5);  // what lies between columns stays
          actual.fill(5);
          row.output = expected.row(0);
          reference(row);
          row.output = actual.row(0);
          kernel(row);
          for (int i = 0; i < expected.width(); ++i) {
            ASSERT_NEAR(actual.at(i, 0), expected.at(i, 0),
                        bound * (1 + std::abs(expected.at(i, 0))))
                << shape.columns << " columns of " << shape.count << ", radius " << radius
                << ", state " << static_cast<int>(state) << ", cell " << i;
          }
        }
      }
    }
  }
};

TEST_P(BayesStep, StartEqualsReference) {
  compare(bayes_start_row, bayes_start_row_ref, 0.01F, 1, 1, 1e-6);
}

TEST_P(BayesStep, HalfEqualsReference) {
  compare(bayes_half_row, bayes_half_row_ref, 0.01F, 1, 1, 2e-6);
}

TEST_P(BayesStep, GeneralEqualsReference) {
  compare(bayes_general_row, bayes_general_row_ref, -8, 0, 0, 5e-6);
}

TEST_P(BayesStep, GeneralSurvivesSumsFarBelowTheRangeOfExponentials) {
  compare(bayes_general_row, bayes_general_row_ref, -300, -290, 0, 5e-4, 1e-30F);
}

TEST_P(BayesStep, ProbabilitiesSumToOne) {
  const int lanes = 64;
  StarRows rows(3, lanes, lanes, 0.01F, 1, 5);
  BayesRow row;
  row.star = rows.star();
  const float tap = 0.99F;
  row.prior = {&tap, 0, 0.01F};
  row.state = BayesState::kProbability;
  row.count = 64;
  row.source_pitch = row.output_pitch = lanes;
  Image<float> work(bayes_work_floats(lanes, 0), 1);
  row.work = work.row(0);
  Image<float> output(lanes * 3, 1);
  row.output = output.row(0);
  bayes_half_row(row);
  for (int x = 0; x < 3; ++x) {
    double sum = 0;
    for (int i = 0; i < lanes; ++i) {
      sum += output.at(x * lanes + i, 0);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, BayesStep, testing::ValuesIn(each_target()), target_test_name);

}  // namespace
}  // namespace vantage::kernels
