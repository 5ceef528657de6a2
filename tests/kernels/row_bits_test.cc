#include "kernels/row_bits/row_bits.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::row_bits_test {

using Bits = std::vector<std::uint64_t>;

VANTAGE_ON_EVERY_TARGET(RowBits);

/// The bits of `answers`, one word after the other.
Bits packed(const std::vector<bool>& answers) {
  Bits words((answers.size() + 63) / 64, 0);
  for (std::size_t x = 0; x < answers.size(); ++x) {
    if (answers[x]) {
      words[x / 64] += std::uint64_t{1} << (x % 64);
    }
  }
  return words;
}

TEST_P(RowBits, NearIsADifferenceUpToTheLimit) {
  std::mt19937 random(1);
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(), 3e38F, -3e38F};
  for (int width = 0; width <= 150; ++width) {
    // Ends of memory, so that the address sanitizer sees any access behind the row.
    UnalignedRow<float> a(width, 1);
    UnalignedRow<float> b(width, 3);
    std::vector<bool> is_near;
    for (std::size_t x = 0; x < a.size(); ++x) {
      for (UnalignedRow<float>* row : {&a, &b}) {
        (*row)[x] = random() % 9 == 0 ? odd[random() % 5]
                                      : 0.25F * static_cast<float>(random_int(random, -8, 8));
      }
      is_near.push_back(std::abs(a[x] - b[x]) <= 1.25F);
    }
    const auto words = static_cast<std::size_t>(row_words(width));
    ASSERT_EQ(
        written_row(words, std::uint64_t{77}, near_bits_row, a.data(), b.data(), 1.25F, width),
        packed(is_near))
        << "width " << width;
  }
}

TEST_P(RowBits, ZeroIsNothingElse) {
  std::mt19937 random(2);
  for (int width = 0; width <= 150; ++width) {
    UnalignedRow<std::uint8_t> values(width, 5);
    std::vector<bool> is_zero;
    for (std::size_t x = 0; x < values.size(); ++x) {
      values[x] = static_cast<std::uint8_t>(random() % 2 == 0 ? 0 : 1U << (random() % 8));
      is_zero.push_back(values[x] == 0);
    }
    const auto words = static_cast<std::size_t>(row_words(width));
    ASSERT_EQ(written_row(words, std::uint64_t{77}, zero_bits_row, values.data(), width),
              packed(is_zero))
        << "width " << width;
  }
}

}  // namespace vantage::kernels::row_bits_test
