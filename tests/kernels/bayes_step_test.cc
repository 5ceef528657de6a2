#include "kernels/bayes_step/bayes_step.h"

#include <memory>

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels::bayes_step_test {

using Kernel = void (*)(const BayesRow&);

struct Shape {
  int columns;
  int count;
};
constexpr Shape kShapes[] = {{1, 1},  {2, 3},  {3, 16},  {5, 17},  {1, 33}, {4, 64},
                             {3, 80}, {2, 96}, {2, 113}, {2, 128}, {1, 300}};

class BayesStep : public EveryTarget {
 protected:
  /// Compares a kernel with its reference on random rows; `low`, `high` bound the cells.
  /// is_weighted: neighbours have weights. is_in_plane: candidates are displacements in two
  /// dimensions, if there are enough.
  static void compare(Kernel kernel, Kernel reference, float low, float high, float neutral,
                      double bound, float floor = 0.01F, bool is_weighted = false,
                      bool is_in_plane = false) {
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
          row.plane = is_in_plane ? plane_of(shape.count, seed) : CandidatePlane{};
          row.prior = {taps.data(), radius, floor};
          row.state = state;
          row.mu = 0.7F;
          row.count = shape.count;
          const std::vector<float> weights = random_weights(3 * shape.columns + 1, seed);
          if (is_weighted) {
            row.weights = {.beside = weights.data(),
                           .above = weights.data() + shape.columns + 1,
                           .below = weights.data() + 2 * shape.columns + 1};
          }
          Image<float> work(bayes_work_floats(lanes, radius, row.plane), 1);
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

 private:
  /// From 0 to 1, both included.
  static std::vector<float> random_weights(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> weights;
    for (int i = 0; i < count; ++i) {
      weights.push_back(static_cast<float>(random_int(random, 0, 64)) / 64);
    }
    return weights;
  }
};

TEST_P(BayesStep, StartEqualsReference) {
  compare(bayes_start_row, bayes_start_row_ref, 0.01F, 1, 1, 1e-6);
}

TEST_P(BayesStep, HalfEqualsReference) {
  compare(bayes_half_row, bayes_half_row_ref, 0.01F, 1, 1, 2e-6);
}

TEST_P(BayesStep, GeneralEqualsReference) {
  compare(bayes_general_row, bayes_general_row_ref, -8, 0, 0, 1e-5);
}

TEST_P(BayesStep, WeightedEqualsReference) {
  compare(bayes_general_row, bayes_general_row_ref, -8, 0, 0, 1e-5, 0.01F, true);
  compare(bayes_general_row, bayes_general_row_ref, -10, 0, 0, 1e-5, 5e-6F, true);
}

TEST_P(BayesStep, InTwoDimensionsEqualsReference) {
  compare(bayes_start_row, bayes_start_row_ref, 0.01F, 1, 1, 1e-6, 0.01F, false, true);
  compare(bayes_half_row, bayes_half_row_ref, 0.01F, 1, 1, 2e-6, 0.01F, false, true);
  compare(bayes_general_row, bayes_general_row_ref, -8, 0, 0, 1e-5, 0.01F, true, true);
}

TEST_P(BayesStep, WeightedSurvivesSumsFarBelowTheRangeOfExponentials) {
  compare(bayes_general_row, bayes_general_row_ref, -300, -290, 0, 5e-4, 1e-30F, true);
}

TEST_P(BayesStep, WeightsOfOneChangeNothing) {
  const int lanes = 48;
  const float tap = 0.99F;
  StarRows rows(5, lanes, lanes, -8, 0, 9);
  BayesRow row;
  row.star = rows.star();
  row.prior = {&tap, 0, 0.01F};
  row.state = BayesState::kProbability;
  row.count = lanes;
  row.source_pitch = row.output_pitch = lanes;
  Image<float> work(bayes_work_floats(lanes, 0), 1);
  row.work = work.row(0);
  const auto result = [&row](StarWeights weights) {
    std::vector<float> output(5 * 48 + 16);
    void* aligned = output.data();
    std::size_t space = output.size() * sizeof(float);
    row.output = static_cast<float*>(std::align(64, 5 * 48 * sizeof(float), aligned, space));
    row.weights = weights;
    bayes_general_row(row);
    return std::vector<float>(row.output, row.output + 5 * 48);
  };
  const std::vector<float> ones(6, 1.0F);
  const std::vector<float> expected = result({});
  const std::vector<float> actual = result({ones.data(), ones.data(), ones.data()});
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(actual[i], expected[i], 2e-6);
  }
}

TEST_P(BayesStep, EachNeighbourHasItsOwnWeight) {
  // Two candidates, and one neighbour at a time that is for the second: weight w makes
  // p(1) ÷ p(0) = 2^(2 w).
  const int lanes = 16;
  const std::vector<float> weights{0.25F, 0.5F, 0.75F, 1.0F};  // left, right, up, down
  for (std::size_t k = 0; k < 4; ++k) {
    StarRows rows(1, lanes, lanes, 0, 0, 1);
    std::fill_n(rows.source(), lanes, 0.0F);
    rows.source()[0] = rows.source()[1] = 1;
    Image<float> states(lanes, 4);
    states.fill(0);
    states.at(0, static_cast<int>(k)) = -2;
    BayesRow row;
    row.star = rows.star();
    row.star.left_of_first = states.row(0);
    row.star.right_of_last = states.row(1);
    row.star.up = states.row(2);
    row.star.down = states.row(3);
    const float tap = 0.99F;
    row.prior = {&tap, 0, 0.01F};
    row.state = BayesState::kProbability;
    row.count = 2;
    row.source_pitch = row.output_pitch = lanes;
    row.weights = {weights.data(), weights.data() + 2, weights.data() + 3};
    Image<float> work(bayes_work_floats(lanes, 0), 1);
    row.work = work.row(0);
    Image<float> output(lanes, 1);
    row.output = output.row(0);
    bayes_general_row(row);
    EXPECT_NEAR(output.at(1, 0) / output.at(0, 0), std::exp2(2 * weights[k]), 1e-4) << k;
  }
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

VANTAGE_EVERY_TARGET_OF(BayesStep);

}  // namespace vantage::kernels::bayes_step_test
