#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernels/row_bits/row_bits.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <class D, class M>
HWY_INLINE std::uint64_t bits_of(D d, M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

// answer(tag, x) returns the mask of one vector of columns starting at x.
template <class D, class Answer>
HWY_INLINE void answer_columns(D d, int width, std::uint64_t* HWY_RESTRICT bits,
                               const Answer& answer) {
  const hn::CappedTag<hn::TFromD<D>, 1> d_one;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int begin = 0; begin < width; begin += 64) {
    const int count = std::min(64, width - begin);
    std::uint64_t word = 0;
    int i = 0;
    for (; i + step <= count; i += step) {
      word |= bits_of(d, answer(d, begin + i)) << i;
    }
    for (; i < count; ++i) {
      word |= bits_of(d_one, answer(d_one, begin + i)) << i;
    }
    bits[begin / 64] = word;
  }
}

void near_bits(const float* HWY_RESTRICT a, const float* HWY_RESTRICT b, float limit, int width,
               std::uint64_t* HWY_RESTRICT bits) {
  answer_columns(hn::ScalableTag<float>(), width, bits, [&](auto d, int x) HWY_ATTR {
    return hn::Le(hn::Abs(hn::Sub(hn::LoadU(d, a + x), hn::LoadU(d, b + x))), hn::Set(d, limit));
  });
}

void zero_bits(const std::uint8_t* HWY_RESTRICT values, int width,
               std::uint64_t* HWY_RESTRICT bits) {
  answer_columns(hn::ScalableTag<std::uint8_t>(), width, bits, [&](auto d, int x) HWY_ATTR {
    return hn::Eq(hn::LoadU(d, values + x), hn::Zero(d));
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(near_bits);
HWY_EXPORT(zero_bits);

void near_bits_row(const float* a, const float* b, float limit, int width, std::uint64_t* bits) {
  HWY_DYNAMIC_DISPATCH(near_bits)(a, b, limit, width, bits);
}
void zero_bits_row(const std::uint8_t* values, int width, std::uint64_t* bits) {
  HWY_DYNAMIC_DISPATCH(zero_bits)(values, width, bits);
}

}  // namespace vantage::kernels
#endif
