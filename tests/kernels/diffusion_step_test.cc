#include "kernels/diffusion_step/diffusion_step.h"

#include <utility>

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels::diffusion_step_test {

/// The equation in double; what rounding may add is a few parts in ten million.
double plain_cell(const DiffusionRow& row, int x, int i) {
  const int lanes = row.star.lanes;
  const double here = row.star.centre[x * lanes + i];
  const auto weight = [&](const float* weights, int at) {
    return row.weights.are_given() ? double{weights[at]} : 1.0;
  };
  const double change = weight(row.weights.beside, x) * (row.star.left_of(x)[i] - here) +
                        weight(row.weights.beside, x + 1) * (row.star.right_of(x)[i] - here) +
                        weight(row.weights.above, x) * (row.star.up[x * lanes + i] - here) +
                        weight(row.weights.below, x) * (row.star.down[x * lanes + i] - here);
  const double pulled = double{row.pull} * (row.star.source[x * lanes + i] - here);
  return here + double{row.step} * change + pulled;
}

TEST(DiffusionStep, IsTheEquation) {
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
        std::vector<float> first;
        for_each_target([&] {
          Image<float> output(lanes * columns, 1);
          row.output = output.row(0);
          diffusion_row(row);
          const std::vector<float> cells(row.output, row.output + output.width());
          for (int i = 0; i < output.width(); ++i) {
            const double expected = plain_cell(row, i / lanes, i % lanes);
            ASSERT_NEAR(cells[i], expected, 1e-6 * 65025) << i;
          }
          ASSERT_TRUE(first.empty() || cells == first) << columns << "x" << lanes;
          first = cells;
        });
      }
    }
  }
}

}  // namespace vantage::kernels::diffusion_step_test
