#include "engine/refinement/uniform_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

constexpr int kWindowRadiusPx = 3;
constexpr int kWindowPx = 2 * kWindowRadiusPx + 1;

/// Sums of |I(x+1) − I(x)| between the columns of a window. Outside the image there are none.
void sum_differences(const float* grey, int width, std::vector<float>& differences, float* sums) {
  differences.assign(static_cast<std::size_t>(width + kWindowPx), 0.0F);
  float* const row = differences.data() + kWindowRadiusPx;
  for (int x = 0; x + 1 < width; ++x) {
    row[x] = std::abs(grey[x + 1] - grey[x]);
  }
  for (int x = 0; x < width; ++x) {
    float sum = 0;
    for (int k = 0; k + 1 < kWindowPx; ++k) {
      sum += differences[static_cast<std::size_t>(x + k)];
    }
    sums[x] = sum;
  }
}

/// Marks the centres of windows without texture.
void mark_flat(const Image<float>& sums, int y, float largest_sum, float* total,
               std::uint8_t* flat) {
  const int width = sums.width();
  std::fill_n(total, width, 0.0F);
  const int end = std::min(y + kWindowRadiusPx + 1, sums.height());
  for (int row = std::max(y - kWindowRadiusPx, 0); row < end; ++row) {
    const float* values = sums.row(row);
    for (int x = 0; x < width; ++x) {
      total[x] += values[x];
    }
  }
  for (int x = 0; x < width; ++x) {
    flat[x] = total[x] <= largest_sum ? 255 : 0;
  }
}

/// Marks the pixels of windows whose centre is marked in `flat`.
void spread(const Mask& flat, int y, std::vector<std::uint8_t>& rows, std::uint8_t* textureless) {
  const int width = flat.width();
  rows.assign(static_cast<std::size_t>(width + kWindowPx), 0);
  std::uint8_t* const row = rows.data() + kWindowRadiusPx;
  const int end = std::min(y + kWindowRadiusPx + 1, flat.height());
  for (int other = std::max(y - kWindowRadiusPx, 0); other < end; ++other) {
    const std::uint8_t* values = flat.row(other);
    for (int x = 0; x < width; ++x) {
      row[x] |= values[x];
    }
  }
  for (int x = 0; x < width; ++x) {
    std::uint8_t any = 0;
    for (int k = 0; k < kWindowPx; ++k) {
      any |= rows[static_cast<std::size_t>(x + k)];
    }
    textureless[x] = any;
  }
}

/// Clears the pixels of a row that are matched or hidden. Works from the side of the nearer surface
/// that hides background: the right one in the left map. Column k from there is x.
class VisibleRow {
 public:
  VisibleRow(const float* map_px, const std::uint8_t* unmatched, int width, Side side,
             float pixels_per_column)
      : map_px_(map_px),
        unmatched_(unmatched),
        width_(width),
        is_left_(side == Side::kLeft),
        pixels_per_column_(pixels_per_column) {}

  void keep_visible(std::uint8_t* uniform) const {
    float covered = -kUnbounded;  // farthest partner of the matched pixels so far

    for (int k = 0; k < width_;) {
      if (unmatched_[column(k)] == 0) {
        covered = std::max(covered, partner(k, map_px_[column(k)]));
        uniform[column(k)] = 0;
        ++k;
        continue;
      }
      int end = k;
      while (end < width_ && unmatched_[column(end)] != 0) {
        ++end;
      }
      const float near_end = k > 0 ? map_px_[column(k - 1)] : kUnbounded;
      const float far_end = end < width_ ? map_px_[column(end)] : kUnbounded;
      const float background = std::min(near_end, far_end);
      for (; k < end; ++k) {
        const float at = partner(k, background);
        if (background == kUnbounded || at <= covered || at < 0 || at > last()) {
          uniform[column(k)] = 0;
        }
      }
    }
  }

 private:
  static constexpr float kUnbounded = std::numeric_limits<float>::max();

  [[nodiscard]] int column(int k) const { return is_left_ ? width_ - 1 - k : k; }
  /// Pixels from the side that is worked from to the partner of column k: growing with k on one
  /// surface.
  [[nodiscard]] float partner(int k, float disparity_px) const {
    return static_cast<float>(k) * pixels_per_column_ + disparity_px;
  }
  [[nodiscard]] float last() const { return static_cast<float>(width_ - 1) * pixels_per_column_; }

  const float* map_px_;
  const std::uint8_t* unmatched_;
  int width_;
  bool is_left_;
  float pixels_per_column_;
};

}  // namespace

void find_textureless_pixels(const Photograph& photograph, double contrast, Execution& execution,
                             UniformPixelsWork& work, Mask& textureless) {
  const int width = photograph.width();
  const int height = photograph.height();
  work.grey.resize(width, height);
  work.sums.resize(width, height);
  work.flat.resize(width, height);
  textureless.resize(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> differences;
    for (int y = first_row; y < end_row; ++y) {
      intensity_row(photograph, y, work.grey.row(y));
      sum_differences(work.grey.row(y), width, differences, work.sums.row(y));
    }
  });
  const auto largest_sum = static_cast<float>(contrast * kWindowPx * (kWindowPx - 1));
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> total(static_cast<std::size_t>(width));
    for (int y = first_row; y < end_row; ++y) {
      mark_flat(work.sums, y, largest_sum, total.data(), work.flat.row(y));
    }
  });
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<std::uint8_t> rows;
    for (int y = first_row; y < end_row; ++y) {
      spread(work.flat, y, rows, textureless.row(y));
    }
  });
}

void keep_visible_unmatched(ImageView<const float> map_px, const Mask& unmatched, Side side,
                            int pixels_per_column, Execution& execution, Mask& uniform) {
  execution.for_each_row(map_px.height(), [&](int y) {
    VisibleRow(map_px.row(y), unmatched.row(y), map_px.width(), side,
               static_cast<float>(pixels_per_column))
        .keep_visible(uniform.row(y));
  });
}

}  // namespace vantage
