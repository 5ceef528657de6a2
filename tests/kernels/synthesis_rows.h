#pragma once

#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/pixel_row/pixel_row.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {

inline constexpr float kUnknownDisparity = std::numeric_limits<float>::quiet_NaN();

/// Widths around vector and block lengths.
inline const std::vector<int> kAwkwardWidths = {1,  2,  3,  4,  5,  7,  8,   9,   15,  16, 17,
                                                31, 33, 63, 64, 65, 97, 127, 129, 200, 257};

/// Piecewise smooth disparities in quarter pixels with jumps and unknown stretches, as maps have.
inline std::vector<float> random_disparities(std::mt19937& random, int width, float min,
                                             float max) {
  std::vector<float> row(width);
  std::uniform_real_distribution<float> level(min, max);
  std::uniform_real_distribution<float> slope(-1.2F, 1.2F);
  float value = level(random);
  float step = slope(random);
  for (float& d : row) {
    const auto event = random() % 16;
    if (event == 0) {
      value = level(random);
      step = random() % 2 == 0 ? 0.0F : slope(random);
    }
    d = event == 1 ? kUnknownDisparity : static_cast<float>(static_cast<int>(value * 4)) / 4;
    value += step;
  }
  return row;
}

/// A row with margins around copies of `values`.
class RowWithMargins {
 public:
  RowWithMargins(const std::vector<float>& values, float margin) {
    memory_.assign(kRowMarginPx, margin);
    memory_.insert(memory_.end(), values.begin(), values.end());
    memory_.insert(memory_.end(), kRowMarginPx, margin);
  }
  [[nodiscard]] const float* row() const { return memory_.data() + kRowMarginPx; }

 private:
  std::vector<float> memory_;
};

/// load_pixel_planes() of interleaved pixels, in memory of exactly the size that may be read.
class PlanesWithMargins {
 public:
  template <typename T>
  PlanesWithMargins(const T* pixels, int width, int channels)
      : stride_(width + 2 * kRowMarginPx), memory_(stride_ * channels) {
    load_pixel_planes(pixels, width, channels, stride_, memory_.data() + kRowMarginPx);
  }
  [[nodiscard]] const float* row() const { return memory_.data() + kRowMarginPx; }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }

 private:
  std::ptrdiff_t stride_;
  std::vector<float> memory_;
};

/// Two warped scanlines with holes, some of whose positions show different surfaces. Colours at
/// holes are 0, as the fetching kernels leave them.
struct RandomPair {
  std::vector<float> left_colours, right_colours, left_d, right_d;
  WarpedPairRow row;

  RandomPair(std::mt19937& random, int width, int channels, float largest) {
    const int lanes = pixel_lanes(channels);
    for (int x = 0; x < width; ++x) {
      const float d = static_cast<float>(random() % 20);
      left_d.push_back(random() % 5 == 0 ? kUnknownDisparity : d);
      right_d.push_back(random() % 5 == 0 ? kUnknownDisparity
                                          : d + static_cast<float>(random() % 7) / 2 - 1.5F);
      for (int c = 0; c < lanes; ++c) {
        const auto draw = [&](float disparity) {
          return c >= channels || std::isnan(disparity)
                     ? 0.0F
                     : largest * static_cast<float>(random() % 10001) / 10000;
        };
        left_colours.push_back(draw(left_d.back()));
        right_colours.push_back(draw(right_d.back()));
      }
    }
    row = {left_colours.data(),
           right_colours.data(),
           left_d.data(),
           right_d.data(),
           width,
           lanes,
           1.0F};
  }
};

}  // namespace vantage::kernels
