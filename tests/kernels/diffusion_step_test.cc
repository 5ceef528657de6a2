#include "kernels/diffusion_step/diffusion_step.h"

#include <utility>

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels::diffusion_step_test {

VANTAGE_ON_EVERY_TARGET(DiffusionStep);

TEST_P(DiffusionStep, EqualsReferenceExactly) {
  unsigned seed = 1;
  for (const int columns : {1, 2, 3, 7}) {
    for (const int lanes : {16, 32, 48, 80, 128}) {
      for (const auto& [pull, weighted] : {std::pair(0.0F, false), std::pair(0.075F, false),
                                           std::pair(0.0F, true), std::pair(0.075F, true)}) {
        StarRows rows(columns, lanes, lanes, 0, 65025, ++seed);
        const RandomStarWeights weights(columns, seed);
        DiffusionRow row;
        row.star = rows.star();
        row.pull = pull;
        row.weights = weighted ? weights.star() : StarWeights{};
        Image<float> expected(lanes * columns, 1);
        Image<float> actual(lanes * columns, 1);
        row.output = expected.row(0);
        diffusion_row_ref(row);
        row.output = actual.row(0);
        diffusion_row(row);
        for (int i = 0; i < lanes * columns; ++i) {
          ASSERT_EQ(actual.at(i, 0), expected.at(i, 0)) << columns << "x" << lanes << " cell " << i;
        }
      }
    }
  }
}

TEST_P(DiffusionStep, PullsEachColumnTowardsItsNeighboursByTheirWeights) {
  constexpr int kColumns = 3;
  constexpr int kLanes = 16;
  constexpr float kPull = 0.075F;
  StarRows rows(kColumns, kLanes, kLanes, 0, 100, 1);
  const RandomStarWeights weights(kColumns, 2);
  DiffusionRow row;
  row.star = rows.star();
  row.pull = kPull;
  row.weights = weights.star();
  Image<float> output(kLanes * kColumns, 1);
  row.output = output.row(0);
  diffusion_row(row);
  for (int x = 0; x < kColumns; ++x) {
    for (int i = 0; i < kLanes; ++i) {
      const double here = row.star.centre[x * kLanes + i];
      const double change = row.weights.beside[x] * (row.star.left_of(x)[i] - here) +
                            row.weights.beside[x + 1] * (row.star.right_of(x)[i] - here) +
                            row.weights.above[x] * (row.star.up[x * kLanes + i] - here) +
                            row.weights.below[x] * (row.star.down[x * kLanes + i] - here);
      const double pulled = kPull * (row.star.source[x * kLanes + i] - here);
      ASSERT_NEAR(output.at(x * kLanes + i, 0), here + 0.15 * change + pulled, 2e-5);
    }
  }
}

}  // namespace vantage::kernels::diffusion_step_test
