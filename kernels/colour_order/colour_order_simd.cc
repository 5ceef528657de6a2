#include "kernels/simd-inl.h"

#include "kernels/colour_order/colour_order.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <typename T>
HWY_INLINE void turn_colours_of(const T* HWY_RESTRICT pixels, int width, T* HWY_RESTRICT turned) {
  const hn::ScalableTag<T> d;
  const int step = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + step <= width; x += step) {
    hn::VFromD<decltype(d)> first;
    hn::VFromD<decltype(d)> second;
    hn::VFromD<decltype(d)> third;
    hn::LoadInterleaved3(d, pixels + 3 * x, first, second, third);
    hn::StoreInterleaved3(third, second, first, d, turned + 3 * x);
  }
  opposite_colour_order_row_ref(pixels + 3 * x, width - x, turned + 3 * x);
}

void turn_colours_8(const std::uint8_t* pixels, int width, std::uint8_t* turned) {
  turn_colours_of(pixels, width, turned);
}

void turn_colours_16(const std::uint16_t* pixels, int width, std::uint16_t* turned) {
  turn_colours_of(pixels, width, turned);
}

void turn_colours_float(const float* pixels, int width, float* turned) {
  turn_colours_of(pixels, width, turned);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(turn_colours_8);
HWY_EXPORT(turn_colours_16);
HWY_EXPORT(turn_colours_float);

void opposite_colour_order_row(const std::uint8_t* pixels, int width, std::uint8_t* turned) {
  HWY_DYNAMIC_DISPATCH(turn_colours_8)(pixels, width, turned);
}

void opposite_colour_order_row(const std::uint16_t* pixels, int width, std::uint16_t* turned) {
  HWY_DYNAMIC_DISPATCH(turn_colours_16)(pixels, width, turned);
}

void opposite_colour_order_row(const float* pixels, int width, float* turned) {
  HWY_DYNAMIC_DISPATCH(turn_colours_float)(pixels, width, turned);
}

// Scalar reference.

namespace {

template <typename T>
void turn_colours(const T* pixels, int width, T* turned) {
  for (int x = 0; x < width; ++x) {
    turned[3 * x] = pixels[3 * x + 2];
    turned[3 * x + 1] = pixels[3 * x + 1];
    turned[3 * x + 2] = pixels[3 * x];
  }
}

}  // namespace

void opposite_colour_order_row_ref(const std::uint8_t* pixels, int width, std::uint8_t* turned) {
  turn_colours(pixels, width, turned);
}

void opposite_colour_order_row_ref(const std::uint16_t* pixels, int width, std::uint16_t* turned) {
  turn_colours(pixels, width, turned);
}

void opposite_colour_order_row_ref(const float* pixels, int width, float* turned) {
  turn_colours(pixels, width, turned);
}

}  // namespace vantage::kernels
#endif
