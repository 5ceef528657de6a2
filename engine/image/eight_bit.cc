#include "engine/image/eight_bit.h"

#include <algorithm>

namespace vantage {
namespace {

template <typename T>
std::uint8_t to_eight_bit(T value) {
  const float levels = static_cast<float>(value) * kGreyLevelsPerUnit<T>;
  return static_cast<std::uint8_t>(std::clamp(levels, 0.0F, 255.0F) + 0.5F);
}

}  // namespace

Image<std::uint8_t> eight_bit(const Photograph& photograph) {
  return std::visit(
      []<typename T>(const Image<T>& image) {
        const int kept = std::min(image.channels(), 3);
        Image<std::uint8_t> result(image.width(), image.height(), kept);
        for (int y = 0; y < image.height(); ++y) {
          for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < kept; ++c) {
              result.at(x, y, c) = to_eight_bit(image.at(x, y, c));
            }
          }
        }
        return result;
      },
      photograph.pixels);
}

}  // namespace vantage
