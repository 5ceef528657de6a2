#include "engine/image/transposed.h"

#include <cstdint>
#include <variant>

#include "engine/image/orientation.h"

namespace vantage {

Photograph transposed(const Photograph& photograph) {
  return std::visit(
      [&]<typename T>(const Image<T>& image) {
        return Photograph{turned<T>(image.view(), Orientation::kTranspose), photograph.origin,
                          transposed(photograph.left_out.view())};
      },
      photograph.pixels);
}

DisparityMap transposed(ImageView<const float> map) {
  return turned<float>(map, Orientation::kTranspose);
}
Mask transposed(ImageView<const std::uint8_t> mask) {
  return turned<std::uint8_t>(mask, Orientation::kTranspose);
}

}  // namespace vantage
