#include "kernels/edge_weights/edge_weights.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::edge_weights_test {

VANTAGE_ON_EVERY_TARGET(EdgeWeightsRow);

TEST_P(EdgeWeightsRow, FallWithTheDifferenceOfGreyLevels) {
  std::mt19937 random(3);
  for (const int count : {0, 1, 2, 3, 7, 8, 15, 16, 17, 31, 64, 101}) {
    for (const EdgeModel& model :
         {EdgeModel{0, 8}, EdgeModel{0.2F, 8}, EdgeModel{0.7F, 0.01F}, EdgeModel{1, 3}}) {
      std::vector<float> pixels;
      for (int x = 0; x < 2 * count + 1; ++x) {
        pixels.push_back(static_cast<float>(random_int(random, 0, 255 * 64)) / 64);
      }
      const float* const second = pixels.data() + count;  // unaligned
      const auto size = static_cast<std::size_t>(count);
      const auto reference = equal_rows<float>(size, edge_weights_row, edge_weights_row_ref,
                                               pixels.data(), second, count, model);
      for (std::size_t x = 0; x < size; ++x) {
        const double difference = std::abs(static_cast<double>(pixels[x]) - second[x]);
        ASSERT_NEAR(reference[x],
                    model.min + (1.0 - model.min) * std::exp(-difference / model.contrast), 1e-5);
        ASSERT_GE(reference[x], model.min);
        ASSERT_LE(reference[x], 1);
      }
    }
  }
}

TEST_P(EdgeWeightsRow, FixedWeightsAreTheNearestOnes) {
  std::mt19937 random(5);
  for (const int count : {0, 1, 2, 3, 7, 8, 15, 16, 17, 31, 64, 101}) {
    for (const float factor : {0.28F, 0.5F, 1.0F}) {
      const auto size = static_cast<std::size_t>(count);
      UnalignedRow<float> weights(size, random() % 5);
      for (std::size_t x = 0; x < size; ++x) {
        weights[x] = static_cast<float>(random_int(random, 0, 1 << 20)) / (1 << 20);
      }
      if (count > 2) {
        weights[0] = 1;  // which has no number of its own
        weights[2] = 0;
      }
      const auto reference = equal_rows<FixedWeight>(size, fixed_weights_row, fixed_weights_row_ref,
                                                     weights.data(), count, factor);
      for (std::size_t x = 0; x < size; ++x) {
        const double units = 32768.0 * static_cast<double>(factor) * weights[x];
        ASSERT_NEAR(reference[x], std::min(units, 32767.0), 0.51);
      }
    }
  }
}

TEST_P(EdgeWeightsRow, EqualPixelsCountInFull) {
  const std::vector<float> pixels(21, 77.25F);
  std::vector<float> weights(20);
  edge_weights_row(pixels.data(), pixels.data() + 1, 20, {0.3F, 8}, weights.data());
  EXPECT_EQ(weights, std::vector<float>(20, 1.0F));
}

}  // namespace vantage::kernels::edge_weights_test
