#include "kernels/candidate_gather/candidate_gather.h"

#include "kernels/row_resampling/row_resampling.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::candidate_gather_test {

template <typename T>
class CandidateGather : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::uint16_t, std::uint32_t, float>;
TYPED_TEST_SUITE(CandidateGather, Types);

TYPED_TEST(CandidateGather, ReadsTheNearestSampleInside) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    const int samples = 1 + static_cast<int>(random() % 40);
    std::vector<TypeParam> row(samples);
    for (TypeParam& value : row) {
      value = static_cast<TypeParam>(random() % 256);
    }
    std::vector<int> offsets(16 * (1 + random() % 3));
    for (int& offset : offsets) {
      offset = static_cast<int>(random() % 120) - 60;
    }
    std::sort(offsets.begin(), offsets.end());
    const GatheredColumns columns{samples - 1, static_cast<int>(random() % 50),
                                  static_cast<int>(random() % 7) - 3, 5,
                                  static_cast<int>(offsets.size())};
    std::vector<TypeParam> values(5 * offsets.size());
    gather_candidates(columns, offsets.data(), row.data(), values.data());
    for (int j = 0; j < columns.columns; ++j) {
      const int first = columns.first_sample + j * columns.column_step;
      const CandidateRange inside =
          candidates_inside(offsets.data(), columns.lanes, columns.last_sample, first);
      for (int i = 0; i < columns.lanes; ++i) {
        const int sample = first + offsets[i];
        ASSERT_EQ(values[j * columns.lanes + i], row[std::clamp(sample, 0, samples - 1)]);
        ASSERT_EQ(i >= inside.begin && i < inside.end, sample >= 0 && sample < samples);
      }
    }
  }
}

TEST(RowResampling, IsExactForLinesAndStaysWithinItsPixels) {
  for (const int width : {1, 2, 3, 4, 9}) {
    std::vector<float> line;
    std::vector<float> steps;
    for (int x = 0; x < width; ++x) {
      line.push_back(static_cast<float>(4 * x));
      steps.push_back(x < width / 2 ? 10.0F : 200.0F);
    }
    std::vector<float> values(line.size());
    for (const float fraction : {0.25F, 0.5F, 0.75F}) {
      resample_row(line.data(), width, fraction, values.data());
      for (int x = 1; x + 2 < width; ++x) {
        EXPECT_EQ(values[x], 4 * (static_cast<float>(x) + fraction));
      }
      resample_row(steps.data(), width, fraction, values.data());
      EXPECT_TRUE(std::ranges::all_of(values, [](float v) { return v >= 10 && v <= 200; }));
    }
  }
}

}  // namespace vantage::kernels::candidate_gather_test
