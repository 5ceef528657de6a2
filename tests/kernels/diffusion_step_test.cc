#include "kernels/diffusion_step/diffusion_step.h"

#include <gtest/gtest.h>

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels {
namespace diffusion_step_test {

class DiffusionStep : public EveryTarget {};

TEST_P(DiffusionStep, EqualsReferenceExactly) {
  unsigned seed = 1;
  for (const int columns : {1, 2, 3, 7}) {
    for (const int lanes : {16, 32, 48, 80, 128}) {
      for (const float pull : {0.0F, 0.075F}) {
        StarRows rows(columns, lanes, lanes, 0, 65025, ++seed);
        DiffusionRow row;
        row.star = rows.star();
        row.pull = pull;
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

INSTANTIATE_TEST_SUITE_P(Targets, DiffusionStep, testing::ValuesIn(each_target()),
                         target_test_name);

}  // namespace diffusion_step_test
}  // namespace vantage::kernels
