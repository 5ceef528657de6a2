#include "engine/refinement/border_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace vantage {
namespace {

// Samples: matched pixels of every second of so many columns beside the band, and of rows up to
// this far away.
constexpr int kColumns = 40;
constexpr int kReachRows = 12;
constexpr int kStep = 2;
constexpr std::size_t kMaxSamples = std::size_t{kColumns / kStep} * (2 * kReachRows / kStep + 1);
constexpr std::size_t kMinSamples = 20;
// Distance from the plane up to which samples take part, one fit after the other; the first plane
// is level, so that its error grows with the distance.
constexpr std::array kTolerancePx = {2.4F, 1.44F, 1.0F, 1.0F};
constexpr float kSteepestStart = 0.03F;
// A plane is believed if so many samples are near it, half of them very near, and it is not steep.
constexpr float kNearPx = 1;
constexpr float kMinNearShare = 0.6F;
constexpr float kVeryNearPx = 0.4F;
constexpr float kSteepestPlane = 0.3F;

struct Sample {
  float x = 0;  // columns from the band, inwards
  float y = 0;  // rows from the row to fill
  float px = 0;
};

struct Plane {
  float px = 0;
  float slope_x = 0;
  float slope_y = 0;

  [[nodiscard]] float error_px(const Sample& sample) const {
    return std::abs(sample.px - (px + slope_x * sample.x + slope_y * sample.y));
  }
};

/// A map seen from the border of its band: column 0 is there.
class FromBorder {
 public:
  FromBorder(const Mask& unmatched, const DisparityMap& map_px, Side side)
      : unmatched_(unmatched), map_px_(map_px), is_left_(side == Side::kLeft) {}

  [[nodiscard]] int column(int x) const { return is_left_ ? x : map_px_.width() - 1 - x; }
  [[nodiscard]] bool is_matched(int x, int y) const { return unmatched_.at(column(x), y) == 0; }

  /// The width of the band; that of the map if nothing is matched.
  [[nodiscard]] int band(int y) const {
    int x = 0;
    while (x < map_px_.width() && !is_matched(x, y)) {
      ++x;
    }
    return x;
  }

  std::span<const Sample> samples(int band, int y, std::array<Sample, kMaxSamples>& samples) const {
    std::size_t count = 0;
    for (int dy = -kReachRows; dy <= kReachRows; dy += kStep) {
      if (y + dy < 0 || y + dy >= map_px_.height()) {
        continue;
      }
      for (int x = band; x < std::min(band + kColumns, map_px_.width()); x += kStep) {
        if (is_matched(x, y + dy)) {
          samples[count++] = {static_cast<float>(x - band), static_cast<float>(dy),
                              map_px_.at(column(x), y + dy)};
        }
      }
    }
    return std::span(samples).first(count);
  }

 private:
  const Mask& unmatched_;
  const DisparityMap& map_px_;
  bool is_left_;
};

/// The plane of least squares of the samples near `before`; none if they do not define one.
std::optional<Plane> fit(std::span<const Sample> samples, const Plane& before, float tolerance_px,
                         float tolerance_per_column_px) {
  double n = 0, x = 0, y = 0, d = 0, xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
  for (const Sample& sample : samples) {
    if (before.error_px(sample) < tolerance_px + tolerance_per_column_px * sample.x) {
      n += 1;
      x += sample.x;
      y += sample.y;
      d += sample.px;
      xx += double{sample.x} * sample.x;
      xy += double{sample.x} * sample.y;
      yy += double{sample.y} * sample.y;
      xd += double{sample.x} * sample.px;
      yd += double{sample.y} * sample.px;
    }
  }
  xx = n * xx - x * x;
  xy = n * xy - x * y;
  yy = n * yy - y * y;
  xd = n * xd - x * d;
  yd = n * yd - y * d;
  const double determinant = xx * yy - xy * xy;
  if (n < kMinSamples || !(determinant > 0)) {
    return std::nullopt;
  }
  const double slope_x = (xd * yy - yd * xy) / determinant;
  const double slope_y = (yd * xx - xd * xy) / determinant;
  return Plane{static_cast<float>((d - slope_x * x - slope_y * y) / n), static_cast<float>(slope_x),
               static_cast<float>(slope_y)};
}

bool is_believed(std::span<const Sample> samples, const Plane& plane) {
  float near = 0;
  float very_near = 0;
  for (const Sample& sample : samples) {
    const float error_px = plane.error_px(sample);
    near += error_px < kNearPx ? 1 : 0;
    very_near += error_px < kVeryNearPx ? 1 : 0;
  }
  const auto count = static_cast<float>(samples.size());
  return near >= kMinNearShare * count && very_near >= 0.5F * count &&
         std::abs(plane.slope_x) <= kSteepestPlane;
}

/// The surface beside the band, whose nearest pixel has the disparity start_px.
std::optional<Plane> plane_beside(std::span<const Sample> samples, float start_px) {
  std::optional<Plane> plane = Plane{.px = start_px};
  float per_column_px = kSteepestStart;
  for (const float tolerance_px : kTolerancePx) {
    plane = fit(samples, *plane, tolerance_px, per_column_px);
    if (!plane) {
      return std::nullopt;
    }
    per_column_px = 0;
  }
  return is_believed(samples, *plane) ? plane : std::nullopt;
}

}  // namespace

void fill_border_planes(const Mask& unmatched, Side side, int pixels_per_column,
                        DisparityRange search, Execution& execution, DisparityMap& map_px) {
  const FromBorder map(unmatched, map_px, side);
  execution.for_each_row(map_px.height(), [&](int y) {
    const int band = map.band(y);
    if (band == 0 || band == map_px.width()) {
      return;
    }
    std::array<Sample, kMaxSamples> samples;
    const std::optional<Plane> plane =
        plane_beside(map.samples(band, y, samples), map_px.at(map.column(band), y));
    if (!plane) {
      return;
    }
    for (int x = 0; x < band; ++x) {
      const float px = std::clamp(plane->px + plane->slope_x * static_cast<float>(x - band),
                                  static_cast<float>(search.min), static_cast<float>(search.max));
      if (static_cast<float>(x * pixels_per_column) < px) {
        map_px.at(map.column(x), y) = px;
      }
    }
  });
}

}  // namespace vantage
