#include "engine/refinement/surface_tiles.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vantage {
namespace {

constexpr int kSampleStep = 2;
constexpr std::size_t kMaxSamples =
    std::size_t{kSurfaceTilePx / kSampleStep} * (kSurfaceTilePx / kSampleStep);
constexpr float kMinSamples = 4;
// Samples farther from the median, and tiles farther per tile of distance, are another surface.
constexpr float kSameSurfacePx = 1.5F;
// Added to the sums of squared places: what is hardly slanted is level.
constexpr double kRidge = 125;

struct TileSample {
  float x = 0;  // from the centre
  float y = 0;
  float px = 0;
  const std::uint8_t* pixel = nullptr;
};

std::span<TileSample> samples_of(const Mask& unmatched, const DisparityMap& map_px,
                                 const FilledMediansWork& medians, int column, int row,
                                 std::array<TileSample, kMaxSamples>& samples) {
  std::size_t count = 0;
  const int left = column * kSurfaceTilePx;
  const int top = row * kSurfaceTilePx;
  for (int y = top; y < std::min(top + kSurfaceTilePx, map_px.height()); y += kSampleStep) {
    for (int x = left; x < std::min(left + kSurfaceTilePx, map_px.width()); x += kSampleStep) {
      if (unmatched.at(x, y) == 0) {
        samples[count++] = {static_cast<float>(x) - tile_centre(column),
                            static_cast<float>(y) - tile_centre(row), map_px.at(x, y),
                            medians.pixel(x, y)};
      }
    }
  }
  return std::span(samples).first(count);
}

float median_of(std::span<const TileSample> samples) {
  std::array<float, kMaxSamples> px;
  std::ranges::transform(samples, px.begin(), &TileSample::px);
  const auto middle = px.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::nth_element(px.begin(), middle, px.begin() + static_cast<std::ptrdiff_t>(samples.size()));
  return *middle;
}

TileMoments moments_of(std::span<const TileSample> samples, SurfaceTile& tile) {
  TileMoments sums;
  tile = {};
  if (samples.empty()) {
    return sums;
  }
  sums.median_px = median_of(samples);
  std::array<int, 3> colour{};
  for (const TileSample& sample : samples) {
    const float d = sample.px - sums.median_px;
    if (!(std::abs(d) < kSameSurfacePx)) {
      continue;
    }
    sums.n += 1;
    sums.x += sample.x;
    sums.y += sample.y;
    sums.xx += sample.x * sample.x;
    sums.xy += sample.x * sample.y;
    sums.yy += sample.y * sample.y;
    sums.d += d;
    sums.xd += sample.x * d;
    sums.yd += sample.y * d;
    for (std::size_t c = 0; c < colour.size(); ++c) {
      colour[c] += sample.pixel[c];
    }
  }
  if (sums.n >= kMinSamples) {
    tile.samples = sums.n;
    const int count = static_cast<int>(sums.n);
    std::ranges::transform(colour, tile.colour.begin(),
                           [&](int sum) { return (sum + count / 2) / count; });
  }
  return sums;
}

/// Sums of a tile that lies (x, y) beside another, as sums of that one.
TileMoments seen_from(const TileMoments& of, float x, float y, float median_px) {
  const float d = of.median_px - median_px;
  return {.median_px = median_px,
          .n = of.n,
          .x = of.x + x * of.n,
          .y = of.y + y * of.n,
          .xx = of.xx + 2 * x * of.x + x * x * of.n,
          .xy = of.xy + x * of.y + y * of.x + x * y * of.n,
          .yy = of.yy + 2 * y * of.y + y * y * of.n,
          .d = of.d + d * of.n,
          .xd = of.xd + x * of.d + d * (of.x + x * of.n),
          .yd = of.yd + y * of.d + d * (of.y + y * of.n)};
}

void add(const TileMoments& one, TileMoments& sums) {
  sums.n += one.n;
  sums.x += one.x;
  sums.y += one.y;
  sums.xx += one.xx;
  sums.xy += one.xy;
  sums.yy += one.yy;
  sums.d += one.d;
  sums.xd += one.xd;
  sums.yd += one.yd;
}

/// Least squares with a ridge for both slopes.
void fit_plane(const TileMoments& sums, SurfaceTile& tile) {
  const double n = sums.n;
  const double xx = n * (sums.xx + kRidge) - double{sums.x} * sums.x;
  const double yy = n * (sums.yy + kRidge) - double{sums.y} * sums.y;
  const double xy = n * sums.xy - double{sums.x} * sums.y;
  const double xd = n * sums.xd - double{sums.x} * sums.d;
  const double yd = n * sums.yd - double{sums.y} * sums.d;
  const double determinant = xx * yy - xy * xy;
  const double slope_x = (xd * yy - yd * xy) / determinant;
  const double slope_y = (yd * xx - xd * xy) / determinant;
  tile.slope_x = static_cast<float>(slope_x);
  tile.slope_y = static_cast<float>(slope_y);
  tile.disparity_px =
      static_cast<float>(sums.median_px + (sums.d - slope_x * sums.x - slope_y * sums.y) / n);
}

void fit_tile(int column, int row, SurfaceTiles& surfaces) {
  SurfaceTile& tile = surfaces.tiles[surfaces.index(column, row)];
  if (tile.samples == 0) {
    return;
  }
  const float median_px = surfaces.moments[surfaces.index(column, row)].median_px;
  TileMoments sums{.median_px = median_px};
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int i = column + dx;
      const int j = row + dy;
      if (i < 0 || i >= surfaces.columns || j < 0 || j >= surfaces.rows ||
          surfaces.tiles[surfaces.index(i, j)].samples == 0) {
        continue;
      }
      const TileMoments& beside = surfaces.moments[surfaces.index(i, j)];
      const float distance = dx != 0 && dy != 0 ? 1.41421356F : 1;
      if (std::abs(beside.median_px - median_px) < kSameSurfacePx * distance) {
        add(seen_from(beside, static_cast<float>(dx * kSurfaceTilePx),
                      static_cast<float>(dy * kSurfaceTilePx), median_px),
            sums);
      }
    }
  }
  fit_plane(sums, tile);
}

}  // namespace

void find_surface_tiles(const Mask& unmatched, const DisparityMap& map_px,
                        const FilledMediansWork& medians, Execution& execution,
                        SurfaceTiles& surfaces) {
  surfaces.columns = (map_px.width() + kSurfaceTilePx - 1) / kSurfaceTilePx;
  surfaces.rows = (map_px.height() + kSurfaceTilePx - 1) / kSurfaceTilePx;
  const std::size_t count = surfaces.index(0, surfaces.rows);
  surfaces.tiles.resize(count);
  surfaces.moments.resize(count);
  execution.for_each_row(surfaces.rows, [&](int row) {
    std::array<TileSample, kMaxSamples> samples;
    for (int column = 0; column < surfaces.columns; ++column) {
      const std::size_t index = surfaces.index(column, row);
      surfaces.moments[index] = moments_of(
          samples_of(unmatched, map_px, medians, column, row, samples), surfaces.tiles[index]);
    }
  });
  execution.for_each_row(surfaces.rows, [&](int row) {
    for (int column = 0; column < surfaces.columns; ++column) {
      fit_tile(column, row, surfaces);
    }
  });
}

}  // namespace vantage
