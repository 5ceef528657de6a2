#include "engine/image/no_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/error.h"
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

/// False, and nothing is written, if the row has no data.
bool fill_row(const float* raster, int width, DataRange range, std::uint16_t* row) {
  const double scale = 65535 / (range.high - range.low);
  const auto level = [&](int x) {
    const double value = (static_cast<double>(raster[x]) - range.low) * scale;
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 65535.0)));
  };
  int last = -1;  // with data
  for (int x = 0; x < width; ++x) {
    if (!std::isfinite(raster[x])) {
      continue;
    }
    row[x] = level(x);
    for (int gap = last + 1; gap < x; ++gap) {
      row[gap] = last >= 0 && gap - last <= x - gap ? row[last] : row[x];
    }
    last = x;
  }
  if (last >= 0) {
    std::fill(row + last + 1, row + width, row[last]);
  }
  return last >= 0;
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
  const int height = raster.height();
  Image<std::uint16_t> image(raster.width(), height);
  std::vector<std::uint8_t> is_filled(static_cast<std::size_t>(height));
  execution.for_each_row(height, [&](int y) {
    is_filled[static_cast<std::size_t>(y)] =
        fill_row(raster.row(y), raster.width(), range, image.row(y)) ? 1 : 0;
  });
  std::vector<int> with_data;
  for (int y = 0; y < height; ++y) {
    if (is_filled[static_cast<std::size_t>(y)] != 0) {
      with_data.push_back(y);
    }
  }
  for (int y = 0; y < height; ++y) {
    if (is_filled[static_cast<std::size_t>(y)] == 0) {
      const int nearest =
          *std::ranges::min_element(with_data, {}, [&](int row) { return std::abs(row - y); });
      std::copy_n(image.row(nearest), image.width(), image.row(y));
    }
  }
  return Photograph{std::move(image)};
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
