#include "engine/refinement/canonical_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/refinement/region_grid.h"

namespace vantage {
namespace {

// Neighbours whose disparities differ by at most this are one surface (EQUATIONS §6).
constexpr float kSurfaceStepPx = 1;
// Disparities on both sides of a region that differ by more per pixel are of two surfaces.
constexpr float kSteepest = 0.1F;
// Ends whose grey levels differ from a region's by at most this look like it.
constexpr float kContrast = 10;
// Cells around a region's bounding box: ends, and what continues them.
constexpr int kMargin = 2;

struct Pixel {
  int x = 0;
  int y = 0;
};
constexpr std::array<Pixel, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// A region: its pixels, and the box around them.
struct UniformRegion {
  std::vector<Pixel> pixels;
  Pixel first;
  Pixel last;
};

/// All 4-connected regions, in the order of their first pixels. Clears `uniform`.
std::vector<UniformRegion> take_regions(Mask& uniform) {
  std::vector<UniformRegion> regions;
  for (int y = 0; y < uniform.height(); ++y) {
    for (int x = 0; x < uniform.width(); ++x) {
      if (uniform.at(x, y) == 0) {
        continue;
      }
      UniformRegion region{.pixels = {{x, y}}, .first = {x, y}, .last = {x, y}};
      uniform.at(x, y) = 0;
      for (std::size_t next = 0; next < region.pixels.size(); ++next) {
        const Pixel pixel = region.pixels[next];
        region.first = {std::min(region.first.x, pixel.x), std::min(region.first.y, pixel.y)};
        region.last = {std::max(region.last.x, pixel.x), std::max(region.last.y, pixel.y)};
        for (const Pixel& step : kNeighbours) {
          const Pixel beside{pixel.x + step.x, pixel.y + step.y};
          if (beside.x >= 0 && beside.x < uniform.width() && beside.y >= 0 &&
              beside.y < uniform.height() && uniform.at(beside.x, beside.y) != 0) {
            uniform.at(beside.x, beside.y) = 0;
            region.pixels.push_back(beside);
          }
        }
      }
      regions.push_back(std::move(region));
    }
  }
  return regions;
}

/// A region on its grid, with the ends that belong to its surface.
class RegionSurface {
 public:
  RegionSurface(const UniformRegion& region, const Image<float>& grey, const Mask& unmatched,
                const DisparityMap& map_px)
      : region_(region),
        grey_(grey),
        unmatched_(unmatched),
        map_px_(map_px),
        origin_{region.first.x - kMargin, region.first.y - kMargin},
        grid_(region.last.x - region.first.x + 1 + 2 * kMargin,
              region.last.y - region.first.y + 1 + 2 * kMargin) {
    for (const Pixel& pixel : region.pixels) {
      grid_.states[index(pixel)] = RegionGrid::kUnknown;
    }
    find_ends();
    leave_out_fronts({1, 0});
    leave_out_fronts({0, 1});
    for (const Pixel& end : ends_) {
      has_ends_ = has_ends_ || state(end) == RegionGrid::kKnown;
    }
    continue_ends();
  }

  [[nodiscard]] bool has_ends() const { return has_ends_; }

  void solve(SurfaceEnergy energy, DisparityRange range, DisparityMap& map_px) {
    solve_surface(energy, grid_);
    for (const Pixel& pixel : region_.pixels) {
      map_px.at(pixel.x, pixel.y) = std::clamp(
          grid_.values[index(pixel)], static_cast<float>(range.min), static_cast<float>(range.max));
    }
  }

 private:
  [[nodiscard]] std::size_t index(Pixel pixel) const {
    return grid_.index(pixel.x - origin_.x, pixel.y - origin_.y);
  }
  [[nodiscard]] RegionGrid::State state(Pixel pixel) const { return grid_.states[index(pixel)]; }
  [[nodiscard]] bool is_inside(Pixel pixel) const {
    return pixel.x >= 0 && pixel.x < map_px_.width() && pixel.y >= 0 && pixel.y < map_px_.height();
  }
  [[nodiscard]] bool is_matched(Pixel pixel) const {
    return is_inside(pixel) && unmatched_.at(pixel.x, pixel.y) == 0;
  }
  [[nodiscard]] float value(Pixel pixel) const { return map_px_.at(pixel.x, pixel.y); }

  void make_known(Pixel pixel) {
    grid_.states[index(pixel)] = RegionGrid::kKnown;
    grid_.values[index(pixel)] = value(pixel);
  }

  void find_ends() {
    for (const Pixel& pixel : region_.pixels) {
      for (const Pixel& step : kNeighbours) {
        const Pixel end{pixel.x + step.x, pixel.y + step.y};
        if (is_matched(end) && state(end) == RegionGrid::kAbsent) {
          make_known(end);
          ends_.push_back(end);
        }
      }
    }
  }

  /// The first matched pixel from `start` on, outside the region; outside the image if none.
  [[nodiscard]] Pixel first_matched(Pixel start, Pixel step) const {
    while (is_inside(start) && unmatched_.at(start.x, start.y) != 0) {
      start = {start.x + step.x, start.y + step.y};
    }
    return start;
  }

  /// Compares the matched pixels at both sides of all runs along `step`, a row's or a column's.
  /// They need not be ends: pixels that are not uniform may lie between.
  void leave_out_fronts(Pixel step) {
    for (const Pixel& pixel : region_.pixels) {
      const Pixel beside{pixel.x - step.x, pixel.y - step.y};
      if (state(beside) == RegionGrid::kUnknown) {
        continue;
      }
      Pixel end = pixel;
      float sum = 0;
      int pixels = 0;
      for (; state(end) == RegionGrid::kUnknown; ++pixels) {
        sum += grey_.at(end.x, end.y);
        end = {end.x + step.x, end.y + step.y};
      }
      const Pixel before = first_matched(beside, {-step.x, -step.y});
      const Pixel after = first_matched(end, step);
      if (!is_inside(before) || !is_inside(after)) {
        continue;
      }
      const float rise_px = value(after) - value(before);
      const int distance_px = after.x - before.x + after.y - before.y;
      if (std::abs(rise_px) <= kSurfaceStepPx + kSteepest * static_cast<float>(distance_px)) {
        continue;
      }
      const float mean = sum / static_cast<float>(pixels);
      const auto looks_alike = [&](Pixel at) {
        return std::abs(grey_.at(at.x, at.y) - mean) <= kContrast;
      };
      const bool is_before_alike = looks_alike(before);
      const bool is_front_after =
          is_before_alike == looks_alike(after) ? rise_px > 0 : is_before_alike;
      if (is_front_after ? is_matched(end) : is_matched(beside)) {
        grid_.states[index(is_front_after ? end : beside)] = RegionGrid::kAbsent;
      }
    }
  }

  /// Adds the matched pixels beside ends that are on their surface: they tell its slope.
  void continue_ends() {
    for (const Pixel& end : ends_) {
      if (state(end) != RegionGrid::kKnown) {
        continue;
      }
      for (const Pixel& step : kNeighbours) {
        const Pixel beside{end.x + step.x, end.y + step.y};
        if (is_matched(beside) && state(beside) == RegionGrid::kAbsent &&
            std::abs(value(beside) - value(end)) <= kSurfaceStepPx) {
          make_known(beside);
        }
      }
    }
  }

  const UniformRegion& region_;
  const Image<float>& grey_;
  const Mask& unmatched_;
  const DisparityMap& map_px_;
  Pixel origin_;
  RegionGrid grid_;
  std::vector<Pixel> ends_;
  bool has_ends_ = false;
};

}  // namespace

void fill_canonically(const Mask& uniform, const Image<float>& grey, SurfaceEnergy energy,
                      DisparityRange range, Execution& execution, Mask& unmatched,
                      DisparityMap& map_px) {
  Mask rest = uniform.copy();
  const std::vector<UniformRegion> regions = take_regions(rest);
  std::vector<char> is_filled(regions.size());
  execution.executor().parallel_for(static_cast<int>(regions.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    RegionSurface surface(regions[i], grey, unmatched, map_px);
    if (surface.has_ends()) {
      surface.solve(energy, range, map_px);
      is_filled[i] = 1;
    }
  });
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (is_filled[i] != 0) {
      for (const Pixel& pixel : regions[i].pixels) {
        unmatched.at(pixel.x, pixel.y) = 0;
      }
    }
  }
}

}  // namespace vantage
