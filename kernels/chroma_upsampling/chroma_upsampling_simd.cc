#include "kernels/simd-inl.h"

#include <algorithm>

#include "kernels/chroma_upsampling/chroma_upsampling.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

constexpr std::int32_t kNearColumn = 9421;  // of 2^14
constexpr std::int32_t kFarColumn = 1229;
constexpr std::int32_t kLargest = (1 << 19) - 1;
/// Half a unit of the result; and its middle, so that sums fit 32 bits.
constexpr std::int32_t kBias = (1 << 14) - (1 << 30);

void columns(const std::uint8_t* samples, int count, std::int32_t* columns) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto load = [&](int i) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(d8, samples + i)); };
  const auto put_single = [&](int i) {
    const auto at = [&](int k) { return std::int32_t{samples[std::clamp(k, 0, count - 1)]}; };
    columns[2 * i] = at(i) * 2048;
    columns[2 * i + 1] = std::min(
        kLargest, (kNearColumn * (at(i) + at(i + 1)) - kFarColumn * (at(i - 1) + at(i + 2))) >> 3);
  };
  int i = 0;
  for (; i < std::min(1, count); ++i) {
    put_single(i);
  }
  for (; i + lanes + 2 <= count; i += lanes) {
    const auto near = hn::Add(load(i), load(i + 1));
    const auto far = hn::Add(load(i - 1), load(i + 2));
    const auto sum =
        hn::Sub(hn::Mul(near, hn::Set(d, kNearColumn)), hn::Mul(far, hn::Set(d, kFarColumn)));
    const auto between = hn::Min(hn::ShiftRight<3>(sum), hn::Set(d, kLargest));
    hn::StoreInterleaved2(hn::ShiftLeft<11>(load(i)), between, d, columns + 2 * i);
  }
  for (; i < count; ++i) {
    put_single(i);
  }
}

void row(const ChromaSourceRows& rows, const ChromaWeights& weights, int width,
         std::uint16_t* chroma) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const hn::RebindToUnsigned<decltype(d16)> d_result;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    auto sum = hn::Set(d, kBias);
    for (std::size_t k = 0; k < 4; ++k) {
      sum = hn::Add(sum, hn::Mul(hn::LoadU(d, rows[k] + x), hn::Set(d, weights[k])));
    }
    // Saturates; then from the middle to 0.
    const auto centred = hn::DemoteTo(d16, hn::ShiftRight<15>(sum));
    hn::StoreU(hn::Xor(hn::BitCast(d_result, centred), hn::Set(d_result, 0x8000)), d_result,
               chroma + x);
  }
  for (; x < width; ++x) {
    std::int64_t sum = kBias;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += std::int64_t{rows[k][x]} * weights[k];
    }
    chroma[x] =
        static_cast<std::uint16_t>(std::clamp<std::int64_t>(sum >> 15, -32768, 32767) + 32768);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(columns);
HWY_EXPORT(row);

void chroma_columns(const std::uint8_t* samples, int count, std::int32_t* result) {
  HWY_DYNAMIC_DISPATCH(columns)(samples, count, result);
}

void chroma_row(const ChromaSourceRows& rows, const ChromaWeights& weights, int width,
                std::uint16_t* chroma) {
  HWY_DYNAMIC_DISPATCH(row)(rows, weights, width, chroma);
}

}  // namespace vantage::kernels
#endif
