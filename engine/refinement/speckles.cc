#include "engine/refinement/speckles.h"

#include <cmath>

namespace vantage {
namespace {

constexpr float kSurfaceStepPx = 1.0F;

/// Collects regions of one map by flooding.
class Flood {
 public:
  Flood(ImageView<const float> map_px, ImageView<const float> map_y_px, SpeckleWork& work,
        Mask& unmatched)
      : map_px_(map_px), map_y_px_(map_y_px), work_(work), unmatched_(unmatched) {
    work_.visited.assign(
        static_cast<std::size_t>(map_px.width()) * static_cast<std::size_t>(map_px.height()), 0);
  }

  /// The region of (x, y), unless it has been collected before.
  const std::vector<std::int32_t>& collect(int x, int y) {
    std::vector<std::int32_t>& region = work_.region;  // also the queue of what is to be looked at
    region.clear();
    visit(x, y);
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int column = region[next] % map_px_.width();
      const int row = region[next] / map_px_.width();
      spread(column, row, column - 1, row);
      spread(column, row, column + 1, row);
      spread(column, row, column, row - 1);
      spread(column, row, column, row + 1);
    }
    return region;
  }

 private:
  void spread(int from_x, int from_y, int x, int y) {
    if (x >= 0 && x < map_px_.width() && y >= 0 && y < map_px_.height() &&
        is_near(map_px_, from_x, from_y, x, y) &&
        (map_y_px_.empty() || is_near(map_y_px_, from_x, from_y, x, y))) {
      visit(x, y);
    }
  }

  static bool is_near(ImageView<const float> map, int from_x, int from_y, int x, int y) {
    return std::abs(map.at(x, y) - map.at(from_x, from_y)) <= kSurfaceStepPx;
  }

  void visit(int x, int y) {
    const std::int32_t pixel = y * map_px_.width() + x;
    std::uint8_t& visited = work_.visited[static_cast<std::size_t>(pixel)];
    if (visited == 0 && unmatched_.at(x, y) == 0) {
      visited = 1;
      work_.region.push_back(pixel);
    }
  }

  ImageView<const float> map_px_;
  ImageView<const float> map_y_px_;
  SpeckleWork& work_;
  const Mask& unmatched_;
};

}  // namespace

void mark_speckles(ImageView<const float> map_px, ImageView<const float> map_y_px, int least_pixels,
                   SpeckleWork& work, Mask& unmatched) {
  Flood flood(map_px, map_y_px, work, unmatched);
  for (int y = 0; y < map_px.height(); ++y) {
    for (int x = 0; x < map_px.width(); ++x) {
      const std::vector<std::int32_t>& region = flood.collect(x, y);
      if (region.size() < static_cast<std::size_t>(least_pixels)) {
        for (const std::int32_t pixel : region) {
          unmatched.at(pixel % map_px.width(), pixel / map_px.width()) = 255;
        }
      }
    }
  }
}

}  // namespace vantage
