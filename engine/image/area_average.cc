#include "engine/image/area_average.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace vantage {
namespace {

/// Pixels of a line that a pixel of a shorter line covers, the first and the last one in part.
struct CoveredPixels {
  int first = 0;
  int last = 0;
  float first_weight = 1;
  float last_weight = 1;

  /// Of pixel i of `count`, which cover `length` pixels.
  CoveredPixels(int i, int count, int length) {
    const double pixels = static_cast<double>(length) / count;
    const double begin = i * pixels;
    const double end = std::min<double>(length, (i + 1) * pixels);
    first = static_cast<int>(begin);
    last = std::max(first, static_cast<int>(std::ceil(end)) - 1);
    first_weight = static_cast<float>(std::min(end, first + 1.0) - begin);
    last_weight = static_cast<float>(end - std::max<double>(last, begin));
  }
  [[nodiscard]] float weight(int pixel) const {
    return pixel == first ? first_weight : pixel == last ? last_weight : 1.0F;
  }
};

}  // namespace

template <typename T>
Photograph area_average(ImageView<const T> image, int width, int height, Execution& execution) {
  const int channels = image.channels();
  Image<T> result(width, height, channels);
  std::vector<CoveredPixels> columns;
  columns.reserve(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) {
    columns.emplace_back(x, width, image.width());
  }
  const float area = static_cast<float>(static_cast<double>(image.width()) / width *
                                        (static_cast<double>(image.height()) / height));
  execution.for_each_band(height, [&](int first_row, int end_row) {
    const std::size_t values =
        static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(channels);
    std::vector<float> sums(values);
    for (int y = first_row; y < end_row; ++y) {
      const CoveredPixels rows(y, height, image.height());
      std::fill(sums.begin(), sums.end(), 0.0F);
      for (int row = rows.first; row <= rows.last; ++row) {
        const T* const source = image.row(row);
        const float weight = rows.weight(row);
        for (std::size_t i = 0; i < values; ++i) {
          sums[i] += weight * static_cast<float>(source[i]);
        }
      }
      for (int x = 0; x < width; ++x) {
        const CoveredPixels& covered = columns[static_cast<std::size_t>(x)];
        for (int c = 0; c < channels; ++c) {
          float sum = 0;
          for (int column = covered.first; column <= covered.last; ++column) {
            sum += covered.weight(column) * sums[static_cast<std::size_t>(column * channels + c)];
          }
          const float mean = sum / area;
          result.at(x, y, c) = static_cast<T>(std::is_integral_v<T> ? mean + 0.5F : mean);
        }
      }
    }
  });
  return Photograph{std::move(result)};
}

template Photograph area_average(ImageView<const std::uint8_t>, int, int, Execution&);
template Photograph area_average(ImageView<const std::uint16_t>, int, int, Execution&);
template Photograph area_average(ImageView<const float>, int, int, Execution&);

}  // namespace vantage
