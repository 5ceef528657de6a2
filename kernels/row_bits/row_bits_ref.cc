#include <algorithm>
#include <cmath>

#include "kernels/row_bits/row_bits.h"

namespace vantage::kernels {
namespace {

template <typename Answer>
void answer_columns(int width, std::uint64_t* bits, const Answer& answer) {
  std::fill_n(bits, row_words(width), std::uint64_t{0});
  for (int x = 0; x < width; ++x) {
    bits[x / 64] |= std::uint64_t{answer(x) ? 1U : 0U} << (x % 64);
  }
}

}  // namespace

void near_bits_row_ref(const float* a, const float* b, float limit, int width,
                       std::uint64_t* bits) {
  answer_columns(width, bits, [&](int x) { return std::abs(a[x] - b[x]) <= limit; });
}

void zero_bits_row_ref(const std::uint8_t* values, int width, std::uint64_t* bits) {
  answer_columns(width, bits, [&](int x) { return values[x] == 0; });
}

}  // namespace vantage::kernels
