#include "engine/examination/image_statistics.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

constexpr float kBlackGrey = 1;
constexpr float kWhiteGrey = 254;
constexpr double kTexturelessSquaredGradient = 4;
/// Pixels over which squared gradients are averaged, across and down.
constexpr int kWindow = 3;

struct RowSums {
  double grey = 0;
  int black = 0;
  int white = 0;
  int textureless = 0;
};

RowSums exposure_of(const std::vector<float>& grey) {
  RowSums sums;
  for (const float value : grey) {
    sums.grey += value;
    sums.black += value <= kBlackGrey ? 1 : 0;
    sums.white += value >= kWhiteGrey ? 1 : 0;
  }
  return sums;
}

/// The last column has the gradient of the one before.
void square_gradients(const std::vector<float>& grey, std::vector<float>& squares) {
  for (std::size_t x = 0; x < grey.size(); ++x) {
    const std::size_t at = grey.size() < 2 ? 0 : std::min(x, grey.size() - 2);
    const float gradient = grey[std::min(at + 1, grey.size() - 1)] - grey[at];
    squares[x] = gradient * gradient;
  }
}

int count_below(const std::array<const std::vector<float>*, kWindow>& rows, double threshold) {
  const int width = static_cast<int>(rows[0]->size());
  int count = 0;
  for (int x = 0; x < width; ++x) {
    double sum = 0;
    for (const std::vector<float>* row : rows) {
      for (int column = x - 1; column <= x + 1; ++column) {
        sum += (*row)[static_cast<std::size_t>(std::clamp(column, 0, width - 1))];
      }
    }
    count += sum < kWindow * kWindow * threshold ? 1 : 0;
  }
  return count;
}

}  // namespace

ImageStatistics image_statistics(const Photograph& photograph, double noise_grey,
                                 Execution& execution) {
  const int width = photograph.width();
  const int height = photograph.height();
  // The difference of two pixels has twice the variance of one.
  const double threshold = kTexturelessSquaredGradient + 2 * noise_grey * noise_grey;
  std::vector<RowSums> rows(static_cast<std::size_t>(height));
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> grey(static_cast<std::size_t>(width));
    std::array<std::vector<float>, kWindow> squares;
    squares.fill(grey);
    const auto read = [&](int y) {
      intensity_row(photograph, y, grey.data());
      square_gradients(grey, squares[static_cast<std::size_t>(y % kWindow)]);
    };
    const auto squares_of = [&](int y) {
      return &squares[static_cast<std::size_t>(std::clamp(y, 0, height - 1) % kWindow)];
    };
    for (int y = std::max(0, first_row - 1); y <= first_row; ++y) {
      read(y);
    }
    for (int y = first_row; y < end_row; ++y) {
      RowSums& sums = rows[static_cast<std::size_t>(y)];
      sums = exposure_of(grey);
      if (y + 1 < height) {
        read(y + 1);
      }
      sums.textureless =
          count_below({squares_of(y - 1), squares_of(y), squares_of(y + 1)}, threshold);
    }
  });
  ImageStatistics statistics{.width_px = width,
                             .height_px = height,
                             .channels = photograph.channels(),
                             .origin = photograph.origin};
  statistics.bits =
      std::visit([](const auto& image) { return static_cast<int>(8 * sizeof(*image.row(0))); },
                 photograph.pixels);
  for (const RowSums& sums : rows) {
    statistics.mean_grey += sums.grey;
    statistics.black_share += sums.black;
    statistics.white_share += sums.white;
    statistics.textureless_share += sums.textureless;
  }
  for (double* value : {&statistics.mean_grey, &statistics.black_share, &statistics.white_share,
                        &statistics.textureless_share}) {
    *value /= static_cast<double>(width) * height;
  }
  return statistics;
}

}  // namespace vantage
