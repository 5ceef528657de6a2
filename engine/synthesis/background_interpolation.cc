#include "engine/synthesis/background_interpolation.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

namespace vantage {
namespace {

constexpr std::array<int, 11> kSampledRows = {0, -1, 1, -2, 2, -4, 4, -8, 8, -16, 16};
constexpr int kRowsPerLength = 4;
constexpr int kBesidePx = 64;
constexpr std::size_t kMostChannels = 4;
constexpr float kNowhere = std::numeric_limits<float>::infinity();

// Number of rows that a sampled one stands for.
float rows_represented(int offset) {
  return std::abs(offset) <= 1 ? 1.0F : 0.75F * static_cast<float>(std::abs(offset));
}

// What is known of a wanted pixel.
struct PixelMean {
  float farthest_above;  // infinity: none
  float farthest_below;
  float background;
  float weight;
  std::array<float, kMostChannels> sums;
};

template <typename T>
class BackgroundInterpolator {
 public:
  BackgroundInterpolator(ImageView<T> image, std::span<const HoleRow> rows, float limit_px)
      : image_(image), rows_(rows), limit_px_(limit_px) {}

  // `means`: of the image's width.
  void fill_row(int y, std::span<PixelMean> means) const {
    const int width = image_.width();
    const std::uint8_t* wanted = row(y).wanted;
    for (int begin = next(wanted, 0, width, true); begin < width;) {
      const int end = next(wanted, begin, width, false);
      if (begin > 0 || end < width) {
        find_background(y, begin, end, means);
        for (const int offset : kSampledRows) {
          if (std::abs(offset) <= kRowsPerLength * (end - begin) && has_row(y + offset)) {
            add_samples(y, offset, begin, end, means);
          }
        }
        write(y, begin, end, means);
      }
      begin = next(wanted, end, width, true);
    }
  }

 private:
  // First pixel from x on that is wanted, or is not.
  static int next(const std::uint8_t* wanted, int x, int end, bool is_wanted) {
    const void* found = std::memchr(wanted + x, is_wanted ? 255 : 0,
                                    static_cast<std::size_t>(std::max(end - x, 0)));
    return found == nullptr ? end
                            : static_cast<int>(static_cast<const std::uint8_t*>(found) - wanted);
  }

  [[nodiscard]] const HoleRow& row(int y) const { return rows_[static_cast<std::size_t>(y)]; }
  [[nodiscard]] bool has_row(int y) const { return y >= 0 && y < image_.height(); }

  void find_background(int y, int begin, int end, std::span<PixelMean> means) const {
    const float* disparity_px = row(y).disparity_px;
    const float before = begin > 0 ? disparity_px[begin - 1] : kNowhere;
    const float after = end < image_.width() ? disparity_px[end] : kNowhere;
    for (int x = begin; x < end; ++x) {
      means[static_cast<std::size_t>(x)] = {kNowhere, kNowhere, 0, 0, {}};
    }
    look_along_columns(y, -1, begin, end, means, &PixelMean::farthest_above);
    look_along_columns(y, 1, begin, end, means, &PixelMean::farthest_below);
    const auto in_columns = [&](int x) {
      const PixelMean& mean = means[static_cast<std::size_t>(x)];
      return std::min(mean.farthest_above, mean.farthest_below);
    };
    for (int x = begin; x < end; ++x) {
      const float columns = std::max({in_columns(x), in_columns(std::max(x - 1, begin)),
                                      in_columns(std::min(x + 1, end - 1))});
      means[static_cast<std::size_t>(x)].background = std::min({before, after, columns});
    }
  }

  // The next pixels in direction `step` that are not wanted.
  void look_along_columns(int y, int step, int begin, int end, std::span<PixelMean> means,
                          float PixelMean::*found) const {
    for (int k = 1; k <= kInterpolationReachRows && has_row(y + k * step); ++k) {
      const std::uint8_t* wanted = row(y + k * step).wanted;
      const float* disparity_px = row(y + k * step).disparity_px;
      bool is_complete = true;
      for (int x = begin; x < end; ++x) {
        float& own = means[static_cast<std::size_t>(x)].*found;
        if (own == kNowhere && wanted[x] == 0) {
          own = disparity_px[x];
        }
        is_complete = is_complete && own != kNowhere;
      }
      if (is_complete) {
        break;
      }
    }
  }

  void add_samples(int y, int offset, int begin, int end, std::span<PixelMean> means) const {
    const std::uint8_t* wanted = row(y + offset).wanted;
    const int first = std::max(begin - kBesidePx, 0);
    const int limit = std::min(end + kBesidePx, image_.width());
    int before = begin;  // the last pixel up to x that is not wanted
    while (before >= first && wanted[before] != 0) {
      --before;
    }
    for (int x = begin; x < end; ++x) {
      before = wanted[x] == 0 ? x : before;
      if (before >= first) {
        add_sample(x, y, before, offset, means[static_cast<std::size_t>(x)]);
      }
    }
    int after = next(wanted, end - 1, limit, false);  // the first one from x on
    for (int x = end - 1; x >= begin; --x) {
      after = wanted[x] == 0 ? x : after;
      if (after != x && after < limit) {
        add_sample(x, y, after, offset, means[static_cast<std::size_t>(x)]);
      }
    }
  }

  void add_sample(int x, int y, int from_x, int offset, PixelMean& mean) const {
    if (row(y + offset).disparity_px[from_x] - mean.background > limit_px_) {
      return;
    }
    const auto aside = static_cast<float>(from_x - x);
    const auto down = static_cast<float>(offset);
    const float weight = rows_represented(offset) / (aside * aside + down * down);
    mean.weight += weight;
    const T* pixel = image_.row(y + offset) + from_x * image_.channels();
    for (int c = 0; c < image_.channels(); ++c) {
      mean.sums[static_cast<std::size_t>(c)] += weight * static_cast<float>(pixel[c]);
    }
  }

  void write(int y, int begin, int end, std::span<PixelMean> means) const {
    for (int x = begin; x < end; ++x) {
      const PixelMean& mean = means[static_cast<std::size_t>(x)];
      for (int c = 0; c < image_.channels() && mean.weight > 0; ++c) {
        const float value = mean.sums[static_cast<std::size_t>(c)] / mean.weight;
        image_.at(x, y, c) = static_cast<T>(std::is_integral_v<T> ? value + 0.5F : value);
      }
    }
  }

  ImageView<T> image_;
  std::span<const HoleRow> rows_;
  float limit_px_;
};

}  // namespace

template <typename T>
void interpolate_background(ImageView<T> image, std::span<const HoleRow> rows, int first_row,
                            int end_row, double gradient_limit_px, Execution& execution) {
  const BackgroundInterpolator<T> interpolator(image, rows, static_cast<float>(gradient_limit_px));
  const auto width = static_cast<std::size_t>(image.width());
  const auto memory = execution.scratch().lease(sizeof(PixelMean) * width);
  const std::span<PixelMean> means(reinterpret_cast<PixelMean*>(memory.data()), width);
  for (int y = first_row; y < end_row; ++y) {
    interpolator.fill_row(y, means);
  }
}

template void interpolate_background(ImageView<std::uint8_t>, std::span<const HoleRow>, int, int,
                                     double, Execution&);
template void interpolate_background(ImageView<std::uint16_t>, std::span<const HoleRow>, int, int,
                                     double, Execution&);
template void interpolate_background(ImageView<float>, std::span<const HoleRow>, int, int, double,
                                     Execution&);

}  // namespace vantage
