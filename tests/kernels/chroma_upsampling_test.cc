#include "kernels/chroma_upsampling/chroma_upsampling.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::chroma_upsampling_test {

VANTAGE_ON_EVERY_TARGET(ChromaUpsampling);

/// Cubic of Mitchell and Netravali with B = 0, C = 0.6.
double cubic(double distance) {
  const double d = std::abs(distance);
  return d < 1 ? 1.4 * d * d * d - 2.4 * d * d + 1 : -0.6 * d * d * d + 3 * d * d - 4.8 * d + 2.4;
}

TEST_P(ChromaUpsampling, ColumnsAreTheCubic) {
  std::mt19937 random(5);
  for (const int count : {1, 2, 3, 4, 17, 18, 19, 35, 67, 1001}) {
    UnalignedRow<std::uint8_t> samples(static_cast<std::size_t>(count), random() % 5);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto kind = random() % 4;
      samples[i] = static_cast<std::uint8_t>(kind == 0 ? 0 : kind == 1 ? 255 : random());
    }
    const auto columns = written_row<std::int32_t>(2 * samples.size(), -7, [&](std::int32_t* row) {
      chroma_columns(samples.data(), count, row);
    });
    for (int x = 0; x < 2 * count; ++x) {
      double expected = 0;
      for (int i = x / 2 - 1; i <= x / 2 + 2; ++i) {
        const int inside = std::clamp(i, 0, count - 1);
        expected += cubic(0.5 * x - i) * samples[static_cast<std::size_t>(inside)];
      }
      // Weights of 14 bits; overshoot is cut above.
      ASSERT_NEAR(columns[static_cast<std::size_t>(x)], std::min(2048 * expected, 524287.0), 110)
          << x << " of " << count;
    }
  }
}

TEST_P(ChromaUpsampling, RowsAreTheCubic) {
  std::mt19937 random(6);
  for (const int width : {0, 1, 7, 8, 16, 33, 1000}) {
    const auto count = static_cast<std::size_t>(width);
    std::vector<UnalignedRow<std::int32_t>> memory;
    for (int k = 0; k < 4; ++k) {
      memory.emplace_back(count, random() % 5);
      for (std::size_t x = 0; x < count; ++x) {
        memory.back()[x] = static_cast<std::int32_t>(random() % (1 << 19)) *
                           static_cast<std::int32_t>(random() % 8 == 0 ? 0 : 1);
        memory.back()[x] = random() % 8 == 0 ? (1 << 19) - 1 : memory.back()[x];
      }
    }
    const ChromaSourceRows rows = {memory[0].data(), memory[1].data(), memory[2].data(),
                                   memory[3].data()};
    for (const bool is_below : {false, true}) {
      ChromaWeights weights = kChromaWeights;
      if (is_below) {
        std::ranges::reverse(weights);
      }
      const auto chroma = written_row<std::uint16_t>(
          count, 99, [&](std::uint16_t* row) { chroma_row(rows, weights, width, row); });
      for (std::size_t x = 0; x < count; ++x) {
        double expected = 0;
        for (int k = 0; k < 4; ++k) {
          expected += cubic(k - (is_below ? 1.25 : 1.75)) * rows[static_cast<std::size_t>(k)][x];
        }
        // Weights of 12 bits.
        ASSERT_NEAR(chroma[x], std::clamp(expected / 8, 0.0, 65535.0), 20) << x << " of " << width;
      }
    }
  }
}

}  // namespace vantage::kernels::chroma_upsampling_test
