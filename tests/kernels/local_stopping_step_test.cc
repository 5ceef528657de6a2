#include "kernels/local_stopping_step/local_stopping_step.h"

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels::local_stopping_step_test {

class LocalStoppingStep : public EveryTarget {
 protected:
  /// Columns whose certainty rises and columns whose certainty falls, ties, and cells beyond the
  /// candidates that would win if they counted.
  static void compare(CertaintyMeasure measure, bool carries_certainty, bool leaves_certainty,
                      bool weighted, float scale = 0.02F) {
    unsigned seed = 1;
    int kept = 0;
    int stepped = 0;
    for (const int columns : {1, 2, 5, 23}) {
      for (const int count : {1, 2, 15, 16, 17, 31, 64, 100}) {
        const int lanes = CandidateGeometry{1, 0, count, -1}.lanes();
        const int pitch = carries_certainty ? lanes + kCertaintyFloats : lanes;
        StarRows rows(columns, lanes, pitch, 0, 900, ++seed);
        for (int x = 0; x < columns; ++x) {
          float* const cells = rows.centre(x);
          if (x % 3 == 1 && count > 2) {
            cells[count / 2] = cells[0] = -1;  // a tie
          }
          if (carries_certainty) {
            // Around what certainties come out as.
            const float typical = measure == CertaintyMeasure::kMargin ? 1e-3F : -1.0F;
            std::fill_n(cells + lanes, kCertaintyFloats, typical * static_cast<float>(x % 4));
          }
        }
        const RandomStarWeights weights(columns, seed);
        LocalStoppingRow row;
        row.star = rows.star();
        row.weights = weighted ? weights.star() : StarWeights{};
        row.measure = measure;
        row.scale = scale;
        row.count = count;
        row.output_pitch = leaves_certainty ? lanes + kCertaintyFloats : lanes;
        Image<float> expected(row.output_pitch * columns, 1);
        Image<float> actual(row.output_pitch * columns, 1);
        row.output = expected.row(0);
        local_stopping_row_ref(row);
        row.output = actual.row(0);
        local_stopping_row(row);
        for (int x = 0; x < columns; ++x) {
          for (int i = 0; i < lanes; ++i) {
            const int cell = x * row.output_pitch + i;
            ASSERT_EQ(actual.at(cell, 0), expected.at(cell, 0))
                << columns << " columns of " << count << ", column " << x << ", lane " << i;
          }
          if (leaves_certainty) {
            const int cell = x * row.output_pitch + lanes;
            const double size = std::abs(expected.at(cell, 0));
            ASSERT_NEAR(actual.at(cell, 0), expected.at(cell, 0),
                        measure == CertaintyMeasure::kEntropy ? 2e-5 * size : 2e-6 * (1 + size));
          }
          const bool is_kept = expected.at(x * row.output_pitch, 0) == rows.centre(x)[0];
          ++(is_kept ? kept : stepped);
        }
      }
    }
    EXPECT_GT(kept, 10);
    EXPECT_GT(stepped, 10);
  }
};

TEST_P(LocalStoppingStep, MarginEqualsReference) {
  compare(CertaintyMeasure::kMargin, true, true, false);
  compare(CertaintyMeasure::kMargin, false, true, true);
  compare(CertaintyMeasure::kMargin, true, false, true);
}

TEST_P(LocalStoppingStep, EntropyEqualsReference) {
  compare(CertaintyMeasure::kEntropy, true, true, false);
  compare(CertaintyMeasure::kEntropy, false, true, true);
  compare(CertaintyMeasure::kEntropy, true, false, true);
}

// So sure that all other candidates together are less than the rounding error of the winner.
TEST_P(LocalStoppingStep, EntropyOfSureColumnsEqualsReference) {
  compare(CertaintyMeasure::kEntropy, false, true, false, 0.5F);
  compare(CertaintyMeasure::kEntropy, false, true, true, 20);
}

VANTAGE_EVERY_TARGET_OF(LocalStoppingStep);

}  // namespace vantage::kernels::local_stopping_step_test
