#pragma once

#include <algorithm>
#include <cmath>

#include "engine/matching/stereo_matcher.h"
#include "perf/view_scenes.h"

namespace vantage::perf {

/// Disparities seen from a view: both maps, the nearer one in front; pixels that neither map has
/// get the farther end of their run.
inline DisparityMap seen_from(const DisparityMaps& maps, double view_x) {
  DisparityMap seen = moved(maps.left.disparity_px, view_x);
  const DisparityMap right = moved(maps.right.disparity_px, view_x - 1);
  const int width = seen.width();
  for (int y = 0; y < seen.height(); ++y) {
    for (int x = 0; x < width; ++x) {
      seen.at(x, y) =
          std::fmax(seen.at(x, y), right.at(x, y));  // fmax() of a number and NaN is the number
    }
    for (int begin = 0; begin < width; ++begin) {
      int end = begin;
      while (end < width && std::isnan(seen.at(end, y))) {
        ++end;
      }
      const float before = begin > 0 ? seen.at(begin - 1, y) : seen.at(std::min(end, width - 1), y);
      const float after = end < width ? seen.at(end, y) : before;
      std::fill(seen.row(y) + begin, seen.row(y) + end, std::min(before, after));
      begin = end;
    }
  }
  return seen;
}

/// 255 within 3 pixels of a disparity step above 1 between neighbours, else 0.
inline Mask near_outlines(const DisparityMap& seen) {
  constexpr int kBandPx = 3;
  const int width = seen.width();
  const int height = seen.height();
  Mask near(width, height);
  near.fill(0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float d = seen.at(x, y);
      if (std::abs(seen.at(std::min(x + 1, width - 1), y) - d) > 1 ||
          std::abs(seen.at(x, std::min(y + 1, height - 1)) - d) > 1) {
        for (int row = std::max(y - kBandPx, 0); row <= std::min(y + kBandPx, height - 1); ++row) {
          std::fill(near.row(row) + std::max(x - kBandPx, 0),
                    near.row(row) + std::min(x + kBandPx, width - 1) + 1, 255);
        }
      }
    }
  }
  return near;
}

}  // namespace vantage::perf
