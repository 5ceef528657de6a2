#include "engine/evaluation/immersive_psnr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "engine/error.h"
#include "engine/evaluation/view_evaluation.h"

namespace vantage {
namespace {

constexpr int kMaxShiftPx = 2;
constexpr double kMaxOffset = 0.01 * 255;
constexpr double kMaxComponentDb = 100;
constexpr std::array<float, 3> kWeights = {4, 1, 1};

/// A value for each of Y, Cb, Cr.
using Components = std::array<double, 3>;

/// Y, Cb and Cr of each pixel, or Y alone.
Image<float> components_of(const Photograph& picture, int channels) {
  Image<float> components(picture.width(), picture.height(), channels);
  std::vector<double> levels;
  for (int y = 0; y < picture.height(); ++y) {
    read_level_row(picture, y, channels, levels);
    float* row = components.row(y);
    std::copy(levels.begin(), levels.end(), row);
    for (std::size_t i = 0; channels == 3 && i < levels.size(); i += 3) {
      const double luma = 0.299 * levels[i] + 0.587 * levels[i + 1] + 0.114 * levels[i + 2];
      row[i] = static_cast<float>(luma);
      row[i + 1] = static_cast<float>((levels[i + 2] - luma) / 1.772);
      row[i + 2] = static_cast<float>((levels[i] - luma) / 1.402);
    }
  }
  return components;
}

/// Squared differences of the pixel at (x, y) of `from`, with `offset` added, to its best partner.
Components best_squares(const Image<float>& from, const Image<float>& to, const Components& offset,
                        int x, int y) {
  const int channels = from.channels();
  std::array<float, 3> shifted{};
  for (int c = 0; c < channels; ++c) {
    shifted[c] = from.at(x, y, c) + static_cast<float>(offset[c]);
  }
  float least = std::numeric_limits<float>::infinity();
  Components best{};
  const int last_u = std::min(from.width() - 1, x + kMaxShiftPx);
  const int last_v = std::min(from.height() - 1, y + kMaxShiftPx);
  for (int v = std::max(0, y - kMaxShiftPx); v <= last_v; ++v) {
    for (int u = std::max(0, x - kMaxShiftPx); u <= last_u; ++u) {
      Components squares{};
      float sum = 0;
      for (int c = 0; c < channels; ++c) {
        const float difference = shifted[c] - to.at(u, v, c);
        squares[c] = difference * difference;
        sum += kWeights[c] * difference * difference;
      }
      if (sum < least) {
        least = sum;
        best = squares;
      }
    }
  }
  return best;
}

/// Mean of `value` over the pixels of `mask`.
template <typename Value>
Components mean_of(const Image<float>& picture, std::optional<ImageView<const std::uint8_t>> mask,
                   const Value& value) {
  Components sum{};
  std::int64_t pixels = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (!mask || mask->row(y)[x] == 255) {
        const Components values = value(x, y);
        std::transform(sum.begin(), sum.end(), values.begin(), sum.begin(), std::plus());
        ++pixels;
      }
    }
  }
  if (pixels == 0) {
    throw Error("no pixels to compare, expected pictures with pixels and a mask that is not empty");
  }
  for (double& component : sum) {
    component /= static_cast<double>(pixels);
  }
  return sum;
}

}  // namespace

double immersive_psnr_db(const Photograph& view, const Photograph& truth,
                         std::optional<ImageView<const std::uint8_t>> mask) {
  require_equal_size("the view", view.width(), view.height(), truth);
  if (mask) {
    require_equal_size("the mask", mask->width(), mask->height(), truth);
  }
  const int channels = compared_channels(view, truth);
  const Image<float> pictures[] = {components_of(view, channels), components_of(truth, channels)};
  Components offset = mean_of(pictures[0], mask, [&](int x, int y) {
    Components difference{};
    for (int c = 0; c < channels; ++c) {
      difference[c] = pictures[1].at(x, y, c) - pictures[0].at(x, y, c);
    }
    return difference;
  });
  for (double& value : offset) {
    value = std::clamp(value, -kMaxOffset, kMaxOffset);
  }
  double worse_db = std::numeric_limits<double>::infinity();
  for (const int from : {0, 1}) {
    const Components squares = mean_of(pictures[0], mask, [&](int x, int y) {
      return best_squares(pictures[from], pictures[1 - from], offset, x, y);
    });
    double sum = 0;
    double weights = 0;
    for (int c = 0; c < channels; ++c) {
      sum += kWeights[c] * std::min(kMaxComponentDb, psnr_db(squares[c]));
      weights += kWeights[c];
    }
    worse_db = squares == Components{} ? worse_db : std::min(worse_db, sum / weights);
    std::transform(offset.begin(), offset.end(), offset.begin(), std::negate());
  }
  return worse_db;
}

}  // namespace vantage
