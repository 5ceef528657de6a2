#pragma once

#include <utility>
#include <variant>

#include "engine/image/image.h"
#include "engine/image/photograph_origin.h"

namespace vantage {

/// A picture as read: 8-bit, 16-bit or float values, 1 (grey), 3 (RGB order) or 4 channels (RGB and
/// alpha). 8-bit values span 0..255, 16-bit 0..65535, float 0..1, all finite.
struct Photograph {
  std::variant<Image<std::uint8_t>, Image<std::uint16_t>, Image<float>> pixels;
  PhotographOrigin origin = {};
  /// 255 where a pixel shows no scene (image/left_out.h); empty: all do.
  Mask left_out = {};

  [[nodiscard]] int width() const {
    return std::visit([](const auto& image) { return image.width(); }, pixels);
  }
  [[nodiscard]] int height() const {
    return std::visit([](const auto& image) { return image.height(); }, pixels);
  }
  [[nodiscard]] int channels() const {
    return std::visit([](const auto& image) { return image.channels(); }, pixels);
  }
};

/// The pixels of `photograph` as values of T, of no size if they were of another type.
template <typename T>
Image<T>& pixels_of(Photograph& photograph) {
  auto* same = std::get_if<Image<T>>(&photograph.pixels);
  return same != nullptr ? *same : photograph.pixels.emplace<Image<T>>();
}

/// An image of that shape in the memory of `photograph`, reused if the type matches; contents are
/// undefined. Do not use the photograph before it has pixels again.
struct ImageShape {
  int width = 0;
  int height = 0;
  int channels = 1;
};
template <typename T>
Image<T> take_image(Photograph& photograph, ImageShape shape) {
  Image<T> image;
  if (auto* same = std::get_if<Image<T>>(&photograph.pixels)) {
    image = std::move(*same);
  }
  image.resize(shape.width, shape.height, shape.channels);
  return image;
}

/// Grey levels (0..255, EQUATIONS §0) per unit of a stored value.
template <typename T>
inline constexpr float kGreyLevelsPerUnit = 1.0F;
template <>
inline constexpr float kGreyLevelsPerUnit<std::uint16_t> = 255.0F / 65535.0F;
template <>
inline constexpr float kGreyLevelsPerUnit<float> = 255.0F;

}  // namespace vantage
