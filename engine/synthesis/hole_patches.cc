#include "engine/synthesis/hole_patches.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr int kSearchRadiusPx = 48;
// Disparities this many limits beyond the background's are of another surface.
constexpr float kFarthestLimits = 4;

}  // namespace

TargetPatch::TargetPatch(const HoleImage& holes, PixelPosition centre) : holes_(holes) {
  const float background_px = holes.disparity_px.at(centre.x, centre.y);
  const bool is_known = !std::isnan(background_px);
  constexpr float kAny = std::numeric_limits<float>::infinity();
  nearest_px_ = is_known ? background_px + holes.limit_px : kAny;
  farthest_px_ = is_known ? background_px - kFarthestLimits * holes.limit_px : -kAny;
  const std::int32_t own = holes.labels.at(centre.x, centre.y);
  const int width = holes.labels.width();
  float sum = 0;
  for (int row = 0; row < kPatchPx; ++row) {
    const int y = centre.y - kPatchRadiusPx + row;
    if (y < 0 || y >= holes.labels.height()) {
      continue;
    }
    for (int column = 0; column < kPatchPx; ++column) {
      const int x = centre.x - kPatchRadiusPx + column;
      if (x < 0 || x >= width) {
        continue;
      }
      // Other holes may be filled at the same time.
      const std::int32_t label = holes.labels.at(x, y);
      if ((label != 0 && label != own) || holes.confidence.at(x, y) == 0 ||
          holes.disparity_px.at(x, y) > nearest_px_) {
        continue;
      }
      sum += holes.confidence.at(x, y);
      std::copy_n(holes.levels.row(y) + 4 * x, 4, &values_[row][4 * column]);
      std::fill_n(&counts_[row][4 * column], 4, std::uint8_t{255});
    }
  }
  confidence_ = sum / (kPatchPx * kPatchPx);
}

std::optional<std::int64_t> TargetPatch::difference(PixelPosition source, bool is_same_surface,
                                                    std::int64_t limit) const {
  const int left = source.x - kPatchRadiusPx;
  const int top = source.y - kPatchRadiusPx;
  const auto& blocked = holes_.blocked;
  if (blocked.at(left + kPatchPx, top + kPatchPx) - blocked.at(left, top + kPatchPx) -
          blocked.at(left + kPatchPx, top) + blocked.at(left, top) !=
      0) {
    return std::nullopt;
  }
  const float farthest_px =
      is_same_surface ? farthest_px_ : -std::numeric_limits<float>::infinity();
  std::int64_t sum = 0;
  for (int row = 0; row < kPatchPx; ++row) {
    const float* disparity_px = holes_.disparity_px.row(top + row) + left;
    bool is_background = true;
    for (int column = 0; column < kPatchPx; ++column) {
      is_background = is_background && disparity_px[column] <= nearest_px_ &&
                      disparity_px[column] >= farthest_px;
    }
    if (!is_background) {
      return std::nullopt;
    }
    const std::uint8_t* values = holes_.levels.row(top + row) + std::ptrdiff_t{4} * left;
    std::int32_t of_row = 0;
    for (std::size_t i = 0; i < kBytes; ++i) {
      const int difference = (values[i] & counts_[row][i]) - values_[row][i];
      of_row += difference * difference;
    }
    sum += of_row;
    if (sum > limit) {
      return sum;
    }
  }
  return sum;
}

std::optional<PixelPosition> find_source(const HoleImage& holes, const TargetPatch& target,
                                         PixelPosition centre) {
  const int width = holes.labels.width();
  const int height = holes.labels.height();
  const std::int32_t* labels = holes.labels.row(centre.y);
  int begin = centre.x;
  int end = centre.x + 1;
  for (; begin > 0 && labels[begin - 1] == labels[centre.x]; --begin) {
  }
  for (; end < width && labels[end] == labels[centre.x]; ++end) {
  }
  const float nearest_px = holes.disparity_px.at(centre.x, centre.y) + holes.limit_px;
  const auto is_background = [&](int x) {
    return x >= 0 && x < width && !(holes.disparity_px.at(x, centre.y) > nearest_px);
  };
  const bool is_left =
      is_background(begin - 1) && !(is_background(end) && end - centre.x < centre.x - begin);
  const int beside = is_left ? begin - 1 - kPatchRadiusPx : end + kPatchRadiusPx;
  const PixelPosition first{std::max(kPatchRadiusPx, beside - kSearchRadiusPx),
                            std::max(kPatchRadiusPx, centre.y - kSearchRadiusPx)};
  const PixelPosition last{std::min(width - 1 - kPatchRadiusPx, beside + kSearchRadiusPx),
                           std::min(height - 1 - kPatchRadiusPx, centre.y + kSearchRadiusPx)};
  for (const bool is_same_surface : {true, false}) {
    std::optional<PixelPosition> best;
    std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
    const auto search = [&](PixelPosition from, PixelPosition to, int step) {
      for (int y = from.y; y <= to.y; y += step) {
        for (int x = from.x; x <= to.x; x += step) {
          const auto difference = target.difference({x, y}, is_same_surface, smallest);
          if (difference && *difference < smallest) {
            smallest = *difference;
            best = {x, y};
          }
        }
      }
    };
    search(first, last, holes.step_px);
    if (best && holes.step_px > 1) {
      const int reach = holes.step_px - 1;
      search({std::max(first.x, best->x - reach), std::max(first.y, best->y - reach)},
             {std::min(last.x, best->x + reach), std::min(last.y, best->y + reach)}, 1);
    }
    if (best) {
      return best;
    }
  }
  return std::nullopt;
}

}  // namespace vantage
