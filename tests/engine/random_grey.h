#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage::test {

/// 8-bit grey noise of `levels` levels; few levels make many ties.
inline Photograph random_grey(int width, int height, int levels, std::uint32_t seed) {
  std::mt19937 random(seed);
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) =
          static_cast<std::uint8_t>(static_cast<int>(random() % static_cast<unsigned>(levels)) *
                                    255 / std::max(1, levels - 1));
    }
  }
  return {std::move(image)};
}

}  // namespace vantage::test
