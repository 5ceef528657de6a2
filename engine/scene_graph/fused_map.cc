#include "engine/scene_graph/fused_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace vantage {
namespace {

/// Disparities of one pixel from several edges, in pixels of the requested length.
struct PixelVotes {
  std::vector<float> matched;
  float farthest_guess = std::numeric_limits<float>::quiet_NaN();

  void clear() {
    matched.clear();
    farthest_guess = std::numeric_limits<float>::quiet_NaN();
  }

  void add(float disparity_px, bool is_guess) {
    if (!is_guess) {
      matched.push_back(disparity_px);
    } else if (!(disparity_px >= farthest_guess)) {
      farthest_guess = disparity_px;
    }
  }

  /// From the matched ones, at least one.
  [[nodiscard]] float decide(float tolerance_px) {
    // Ascending, so that of equally large groups the farthest comes first, and sums do not depend
    // on the order of the edges.
    std::sort(matched.begin(), matched.end());
    float best = matched.front();
    int max = 0;
    for (const float centre : matched) {
      float sum = 0;
      int supporters = 0;
      for (const float other : matched) {
        if (std::abs(other - centre) <= tolerance_px) {
          sum += other;
          ++supporters;
        }
      }
      if (supporters > max) {
        max = supporters;
        best = sum / static_cast<float>(supporters);
      }
    }
    return best;
  }
};

float decide(PixelVotes& own, PixelVotes& others, float tolerance_px) {
  if (!own.matched.empty()) {
    return own.decide(tolerance_px);
  }
  if (!others.matched.empty()) {
    return others.decide(tolerance_px);
  }
  return std::isnan(own.farthest_guess) ? others.farthest_guess : own.farthest_guess;
}

}  // namespace

void fuse_maps(std::span<const MapOfEdge> maps, double length, double tolerance_px,
               ImageView<float> fused_px, Execution& execution) {
  const auto tolerance = static_cast<float>(tolerance_px);
  execution.for_each_band(fused_px.height(), [&](int first_row, int end_row) {
    PixelVotes own;
    PixelVotes others;
    for (int y = first_row; y < end_row; ++y) {
      for (int x = 0; x < fused_px.width(); ++x) {
        own.clear();
        others.clear();
        for (const MapOfEdge& map : maps) {
          const float d = map.disparity_px.at(x, y);
          if (std::isfinite(d)) {
            const auto scaled = static_cast<float>(double{d} * (length / map.edge_length));
            (map.is_own ? own : others).add(scaled, map.is_unmatched.at(x, y) != 0);
          }
        }
        fused_px.at(x, y) = decide(own, others, tolerance);
      }
    }
  });
}

}  // namespace vantage
