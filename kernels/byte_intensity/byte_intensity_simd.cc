#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/byte_intensity/byte_intensity.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void rounded(const float* intensities, int width, std::uint8_t* rounded) {
  const hn::ScalableTag<float> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const int step = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + step <= width; x += step) {
    hn::StoreU(hn::DemoteTo(d8, hn::NearestInt(hn::LoadU(d, intensities + x))), d8, rounded + x);
  }
  rounded_intensity_row_ref(intensities + x, width - x, rounded + x);
}

void halved(const std::uint8_t* upper, const std::uint8_t* lower, int width, std::uint8_t* halved) {
  int x = 0;
  const hn::ScalableTag<std::uint8_t> d8;
  const hn::Repartition<std::uint16_t, decltype(d8)> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> half;
  const auto low = hn::Set(d16, 0xFF);
  const auto two = hn::Set(d16, 2);
  const int step = static_cast<int>(hn::Lanes(d16));
  for (; 2 * (x + step) <= width; x += step) {
    const auto above = hn::BitCast(d16, hn::LoadU(d8, upper + 2 * x));
    const auto below = hn::BitCast(d16, hn::LoadU(d8, lower + 2 * x));
    const auto left = hn::Add(hn::And(above, low), hn::And(below, low));
    const auto right = hn::Add(hn::ShiftRight<8>(above), hn::ShiftRight<8>(below));
    const auto mean = hn::ShiftRight<2>(hn::Add(hn::Add(left, right), two));
    hn::StoreU(hn::DemoteTo(half, hn::BitCast(hn::RebindToSigned<decltype(d16)>(), mean)), half,
               halved + x);
  }
  halved_intensity_row_ref(upper + 2 * x, lower + 2 * x, width - 2 * x, halved + x);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(rounded);
HWY_EXPORT(halved);

void rounded_intensity_row(const float* intensities, int width, std::uint8_t* rounded) {
  HWY_DYNAMIC_DISPATCH(rounded)(intensities, width, rounded);
}
void halved_intensity_row(const std::uint8_t* upper, const std::uint8_t* lower, int width,
                          std::uint8_t* halved) {
  HWY_DYNAMIC_DISPATCH(halved)(upper, lower, width, halved);
}

// Scalar reference.

void rounded_intensity_row_ref(const float* intensities, int width, std::uint8_t* rounded) {
  std::transform(intensities, intensities + width, rounded, [](float intensity) {
    return static_cast<std::uint8_t>(std::nearbyint(intensity));
  });
}

void halved_intensity_row_ref(const std::uint8_t* upper, const std::uint8_t* lower, int width,
                              std::uint8_t* halved) {
  for (int x = 0; x < (width + 1) / 2; ++x) {
    const int right = std::min(2 * x + 1, width - 1);
    halved[x] = static_cast<std::uint8_t>(
        (upper[2 * x] + upper[right] + lower[2 * x] + lower[right] + 2) / 4);
  }
}

}  // namespace vantage::kernels
#endif
