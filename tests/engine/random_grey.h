#pragma once

#include "engine/image/image.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// 8-bit grey noise of `levels` levels; few levels make many ties.
inline Photograph random_grey(int width, int height, int levels, std::uint32_t seed) {
  std::mt19937 random(seed);
  Image<std::uint8_t> image(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    image.at(x, y) = static_cast<std::uint8_t>(
        static_cast<int>(random() % static_cast<unsigned>(levels)) * 255 / std::max(1, levels - 1));
  }
  return {std::move(image)};
}

}  // namespace test
}  // namespace vantage
