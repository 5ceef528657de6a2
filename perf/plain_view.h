#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage::perf {

/// A simple hand-written view synthesis: forward-maps both images to the nearest pixel with a
/// z-buffer. Where they agree within one pixel of disparity, averages by distance; otherwise takes
/// the nearer one. Fills holes with the farther of the two pixels at the ends of their run. 8-bit
/// images.
inline Photograph plain_view(const Photograph& left, const Photograph& right,
                             const DisparityMaps& maps, double view_x) {
  struct Warped {
    std::vector<double> disparity, colour;
  };
  const auto& left_pixels = std::get<Image<std::uint8_t>>(left.pixels);
  const auto& right_pixels = std::get<Image<std::uint8_t>>(right.pixels);
  const int width = left.width();
  const int channels = left.channels();
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  const auto warp = [&](const Image<std::uint8_t>& image, const DisparityMap& map, double offset,
                        int y) {
    Warped row{std::vector<double>(static_cast<std::size_t>(width), kNone),
               std::vector<double>(static_cast<std::size_t>(width * channels))};
    for (int x = 0; x < width; ++x) {
      const double d = map.at(x, y);
      const double place = std::isfinite(d) ? std::floor(x - offset * d + 0.5) : -1;
      if (place >= 0 && place < width && d > row.disparity[static_cast<std::size_t>(place)]) {
        const auto target = static_cast<std::size_t>(place);
        row.disparity[target] = d;
        for (int c = 0; c < channels; ++c) {
          row.colour[target * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)] =
              image.at(x, y, c);
        }
      }
    }
    return row;
  };
  Image<std::uint8_t> result(width, left.height(), channels);
  for (int y = 0; y < left.height(); ++y) {
    Warped row = warp(left_pixels, maps.left.disparity_px, view_x, y);
    const Warped other = warp(right_pixels, maps.right.disparity_px, view_x - 1, y);
    const double alpha = std::abs(view_x - 1) / (std::abs(view_x) + std::abs(view_x - 1));
    const auto value = [&](const Warped& from, std::size_t x, int c) {
      return from.colour[x * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
    };
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      const double d = row.disparity[x];
      const double e = other.disparity[x];
      const bool same = d != kNone && e != kNone && std::abs(d - e) <= 1;
      const double share = same ? alpha : d >= e ? 1 : 0;
      for (int c = 0; c < channels; ++c) {
        row.colour[x * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)] =
            share * value(row, x, c) + (1 - share) * value(other, x, c);
      }
      row.disparity[x] = std::max(d, e);
    }
    for (int begin = 0; begin < width;) {
      if (row.disparity[static_cast<std::size_t>(begin)] != kNone) {
        ++begin;
        continue;
      }
      int end = begin;
      while (end < width && row.disparity[static_cast<std::size_t>(end)] == kNone) {
        ++end;
      }
      const bool has_left = begin > 0;
      const bool has_right = end < width;
      const bool take_left =
          has_left && (!has_right || row.disparity[static_cast<std::size_t>(begin - 1)] <=
                                         row.disparity[static_cast<std::size_t>(end)]);
      if (has_left || has_right) {
        const auto source = static_cast<std::size_t>(take_left ? begin - 1 : end);
        for (int x = begin; x < end; ++x) {
          for (int c = 0; c < channels; ++c) {
            row.colour[static_cast<std::size_t>(x * channels + c)] = value(row, source, c);
          }
        }
      }
      begin = end;
    }
    for (int i = 0; i < width * channels; ++i) {
      result.row(y)[i] =
          static_cast<std::uint8_t>(std::floor(row.colour[static_cast<std::size_t>(i)] + 0.5));
    }
  }
  return {std::move(result)};
}

}  // namespace vantage::perf
