#include "engine/scene_graph/sheared_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "engine/image/remapped_row.h"

namespace vantage {
namespace {

constexpr std::uint8_t kUnmatched = 255;
constexpr float kOneSurface_px = 1;

/// Row of the sheared image for position (x, y) of the image: ≥ 0.
double sheared_row(const Shear& shear, int x, int y) { return y - shear.slope * x + shear.offset; }

/// The disparity at the fractional `row` of a column.
float between_rows(ImageView<const float> map, int x, double row) {
  const int upper = std::min(static_cast<int>(row), map.height() - 1);
  const int lower = std::min(upper + 1, map.height() - 1);
  const auto share = static_cast<float>(row - upper);
  const float above = map.at(x, upper);
  const float below = map.at(x, lower);
  if (std::abs(below - above) <= kOneSurface_px) {  // false if one is unknown
    return above + share * (below - above);
  }
  return share < 0.5F ? above : below;
}

}  // namespace

Shear::Shear(double slope_of_lines, int width_px)
    : slope(slope_of_lines),
      offset(static_cast<int>(std::ceil(std::max(slope_of_lines, 0.0) * (width_px - 1)))) {}

int Shear::height(int height_px, int width_px) const {
  return height_px + static_cast<int>(std::ceil(std::abs(slope) * (width_px - 1)));
}

Photograph sheared(const Photograph& photograph, const Shear& shear, Execution& execution) {
  const int width = photograph.width();
  const double last_row = photograph.height() - 1;
  std::vector<float> x_px(static_cast<std::size_t>(width));
  for (std::size_t x = 0; x < x_px.size(); ++x) {
    x_px[x] = static_cast<float>(x);
  }
  Photograph result;
  std::visit(
      [&]<typename T>(const Image<T>& from) {
        Image<T> to(width, shear.height(from.height(), width), from.channels());
        execution.for_each_band(to.height(), [&](int first_row, int end_row) {
          std::vector<float> y_px(static_cast<std::size_t>(width));
          for (int y = first_row; y < end_row; ++y) {
            for (int x = 0; x < width; ++x) {
              const double row = y + shear.slope * x - shear.offset;
              y_px[static_cast<std::size_t>(x)] =
                  static_cast<float>(std::clamp(row, 0.0, last_row));
            }
            remap_row(from, x_px.data(), y_px.data(), y, to);
          }
        });
        result = {std::move(to), photograph.origin};
      },
      photograph.pixels);
  return result;
}

DisparityMap unsheared_disparity(ImageView<const float> map, const Shear& shear, int height_px,
                                 Execution& execution) {
  DisparityMap result(map.width(), height_px);
  execution.for_each_row(height_px, [&](int y) {
    for (int x = 0; x < map.width(); ++x) {
      result.at(x, y) = between_rows(map, x, sheared_row(shear, x, y));
    }
  });
  return result;
}

Mask unsheared_mask(ImageView<const std::uint8_t> mask, const Shear& shear, int height_px) {
  Mask result(mask.width(), height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const auto row = static_cast<int>(std::floor(sheared_row(shear, x, y) + 0.5));
      result.at(x, y) = mask.at(x, std::min(row, mask.height() - 1));
    }
  }
  return result;
}

void mark_partners_beyond_border(ImageView<const float> map, const Shear& shear,
                                 int partner_direction, ImageView<std::uint8_t> unmatched) {
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double partner = y + partner_direction * shear.slope * double{map.at(x, y)};
      if (!(partner >= -0.5 && partner <= map.height() - 0.5)) {
        unmatched.at(x, y) = kUnmatched;
      }
    }
  }
}

}  // namespace vantage
