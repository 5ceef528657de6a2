#include "kernels/colour_order/colour_order.h"

namespace vantage::kernels {
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
