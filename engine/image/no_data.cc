#include "engine/image/no_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr double kClippedShare = 0.005;  // on either side
constexpr std::size_t kMaxSamples = std::size_t{1} << 20;

struct DataRange {
  double low = 0;
  double high = 1;
};

/// From evenly spaced pixels, so that large rasters take no longer.
DataRange range_of_data(ImageView<const float> raster) {
  const std::size_t width = static_cast<std::size_t>(raster.width());
  const std::size_t pixels = width * static_cast<std::size_t>(raster.height());
  const auto sample = [&](std::size_t step) {
    std::vector<float> values;
    for (std::size_t i = 0; i < pixels; i += step) {
      const float value = raster.row(static_cast<int>(i / width))[i % width];
      if (std::isfinite(value)) {
        values.push_back(value);
      }
    }
    return values;
  };
  // Odd steps do not fall into columns.
  std::vector<float> values = sample(pixels / kMaxSamples | 1U);
  if (values.empty()) {
    values = sample(1);
  }
  const auto value_at = [&](double share) {
    return static_cast<double>(percentile(values, share));
  };
  DataRange range{value_at(kClippedShare), value_at(1 - kClippedShare)};
  if (!(range.high > range.low)) {
    range = {range.low - 0.5, range.low + 0.5};
  }
  return range;
}

}  // namespace

bool has_data(ImageView<const float> raster) {
  for (int y = 0; y < raster.height(); ++y) {
    if (std::any_of(raster.row(y), raster.row(y) + raster.width(),
                    [](float value) { return std::isfinite(value); })) {
      return true;
    }
  }
  return false;
}

Photograph photograph_without_gaps(ImageView<const float> raster, Execution& execution) {
  const DataRange range = range_of_data(raster);
  const double scale = 65535 / (range.high - range.low);
  Image<std::uint16_t> image(raster.width(), raster.height());
  Mask without_data(raster.width(), raster.height());
  execution.for_each_row(raster.height(), [&](int y) {
    for (int x = 0; x < raster.width(); ++x) {
      const bool has_value = std::isfinite(raster.at(x, y));
      const double value =
          has_value ? (static_cast<double>(raster.at(x, y)) - range.low) * scale : 0;
      image.at(x, y) = static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 65535.0)));
      without_data.at(x, y) = has_value ? 0 : 255;
    }
  });
  Photograph photograph{std::move(image)};
  leave_out(photograph, std::move(without_data));
  return photograph;
}

void disparities_of_data(const MatchedMap& map, ImageView<const float> left,
                         ImageView<const float> right, Execution& execution,
                         DisparityMap& disparities_px) {
  const int width = left.width();
  const int height = left.height();
  if (right.width() != width || right.height() != height || map.disparity_px.width() != width ||
      map.disparity_px.height() != height) {
    throw Error("rasters and their map differ in size, expected equal sizes");
  }
  disparities_px.resize(width, height);
  execution.for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const float d = map.disparity_px.at(x, y);
      const float at = std::round(static_cast<float>(x) - d);  // NaN: in no range
      const bool has_match = std::isfinite(left.at(x, y)) && map.unmatched.at(x, y) == 0 &&
                             at >= 0 && at < static_cast<float>(width) &&
                             std::isfinite(right.at(static_cast<int>(at), y));
      disparities_px.at(x, y) = has_match ? d : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

}  // namespace vantage
