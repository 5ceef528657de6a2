#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/match_options.h"

namespace vantage::test {

/// Grey levels of a photograph as EQUATIONS §0 defines them, in double.
inline std::vector<double> grey_levels_of(const Photograph& photograph) {
  std::vector<double> grey;
  std::visit(
      [&](const auto& image) {
        using T = std::remove_cvref_t<decltype(image.at(0, 0))>;
        const double unit = std::is_same_v<T, std::uint8_t>    ? 1.0
                            : std::is_same_v<T, std::uint16_t> ? 255.0 / 65535.0
                                                               : 255.0;
        for (int y = 0; y < image.height(); ++y) {
          for (int x = 0; x < image.width(); ++x) {
            if (image.channels() < 3) {
              grey.push_back(image.at(x, y) * unit);
            } else {
              grey.push_back((0.299 * image.at(x, y, 0) + 0.587 * image.at(x, y, 1) +
                              0.114 * image.at(x, y, 2)) *
                             unit);
            }
          }
        }
      },
      photograph.pixels);
  return grey;
}

/// SSD straight from EQUATIONS §1, candidate by candidate and sample by sample.
struct BruteForceSsd {
  int width = 0;
  int height = 0;
  std::vector<double> reference;
  std::vector<double> other;
  int direction = -1;  // the partner of x is x + direction · d

  [[nodiscard]] bool inside(int x) const { return x >= 0 && x < width; }

  /// Mean over the window, NaN when (x, y, d) is no candidate.
  [[nodiscard]] double energy(int x, int y, int d, int window, Border border) const {
    const int radius = window / 2;
    if (!inside(x + direction * d)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    double sum = 0;
    int count = 0;
    for (int v = y - radius; v <= y + radius; ++v) {
      for (int u = x - radius; u <= x + radius; ++u) {
        const int partner = u + direction * d;
        if (v < 0 || v >= height || !inside(u) || !inside(partner)) {
          continue;
        }
        const double difference = reference[static_cast<std::size_t>(v * width + u)] -
                                  other[static_cast<std::size_t>(v * width + partner)];
        sum += difference * difference;
        ++count;
      }
    }
    if (border == Border::kValid && count < window * window) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return sum / count;
  }

  [[nodiscard]] double disparity(int x, int y, const MatchOptions& options) const {
    const auto energy_at = [&](int d) {
      return d < options.disparities.min || d > options.disparities.max
                 ? std::numeric_limits<double>::quiet_NaN()
                 : energy(x, y, d, options.resolved().window_px, options.resolved().border);
    };
    double best_energy = std::numeric_limits<double>::infinity();
    int best = 0;
    for (int d = options.disparities.min; d <= options.disparities.max; ++d) {
      if (const double candidate = energy_at(d); candidate < best_energy) {  // false for NaN
        best_energy = candidate;
        best = d;
      }
    }
    if (std::isinf(best_energy)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (options.resolved().subpixel == Subpixel::kParabola) {
      const double below = energy_at(best - 1);
      const double above = energy_at(best + 1);
      const double curvature = below - 2 * best_energy + above;
      if (curvature > 0) {  // false when a neighbour is no candidate
        return best + (below - above) / (2 * curvature);
      }
    }
    return best;
  }
};

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
