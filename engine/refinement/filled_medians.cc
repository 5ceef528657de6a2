#include "engine/refinement/filled_medians.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <variant>

#include "kernels/filled_median/filled_median.h"

namespace vantage {
namespace {

constexpr int kReachPx = kernels::kFilledMedianReachPx;
constexpr int kMarginPx = kernels::kFilledMedianMarginPx;
static_assert(kernels::kFilledPixelBytes == 4);

template <typename T>
std::uint8_t grey_level(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value;
  } else {
    const float level = static_cast<float>(value) * kGreyLevelsPerUnit<T>;
    return static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F) + 0.5F);
  }
}

/// Builds `framed` with the kernel's margins: they are filled with `outside`, and write_row(y,
/// values) writes map row y from column 0.
template <typename T, class WriteRow>
void frame(int width, int height, int channels, T outside, const WriteRow& write_row,
           Execution& execution, Image<T>& framed) {
  framed.resize(kMarginPx + width + kMarginPx, kReachPx + height + kReachPx, channels);
  execution.for_each_row(framed.height(), [&](int row) {
    T* const values = framed.row(row);
    T* const end = values + framed.width() * channels;
    const int y = row - kReachPx;
    if (y < 0 || y >= height) {
      std::fill(values, end, outside);
      return;
    }
    std::fill_n(values, kMarginPx * channels, outside);
    write_row(y, values + kMarginPx * channels);
    std::fill(values + (kMarginPx + width) * channels, end, outside);
  });
}

/// Three channels in grey levels, padded with a 0.
template <typename T>
void write_pixels(const T* photograph, int width, int channels, std::uint8_t* pixels) {
  if (channels == 1) {
    for (int x = 0; x < width; ++x) {  // a vector at a time
      const std::uint32_t grey = grey_level(photograph[x]);
      const std::uint32_t pixel = grey | grey << 8 | grey << 16;
      std::memcpy(pixels + std::ptrdiff_t{kernels::kFilledPixelBytes} * x, &pixel, sizeof(pixel));
    }
    return;
  }
  int x = 0;
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    if (channels == 3) {  // four bytes at once, but where they would end after the row
      for (; x + 1 < width; ++x) {
        std::memcpy(pixels, photograph, kernels::kFilledPixelBytes);
        pixels[3] = 0;
        photograph += 3;
        pixels += kernels::kFilledPixelBytes;
      }
    }
  }
  for (; x < width; ++x) {
    pixels[0] = grey_level(photograph[0]);
    pixels[1] = grey_level(photograph[1]);
    pixels[2] = grey_level(photograph[2]);
    pixels[3] = 0;
    photograph += channels;
    pixels += kernels::kFilledPixelBytes;
  }
}

template <typename T>
T* inside(Image<T>& framed, int y) {
  return framed.row(kReachPx + y) + kMarginPx * framed.channels();
}

}  // namespace

void frame_photograph(const Photograph& photograph, Execution& execution, FilledMediansWork& work) {
  std::visit(
      [&](const auto& image) {
        frame(
            image.width(), image.height(), kernels::kFilledPixelBytes, std::uint8_t{0},
            [&](int y, std::uint8_t* pixels) {
              write_pixels(image.row(y), image.width(), image.channels(), pixels);
            },
            execution, work.pixels);
      },
      photograph.pixels);
}

void take_filled_medians(const Mask& unmatched, const kernels::FilledMedianGrid& grid,
                         Execution& execution, FilledMediansWork& work, DisparityMap& map_px,
                         const TileMask* tiles) {
  const int width = map_px.width();
  const int height = map_px.height();
  frame(
      width, height, 1, std::numeric_limits<float>::quiet_NaN(),
      [&](int y, float* values) { std::copy_n(map_px.row(y), width, values); }, execution,
      work.before);
  execution.for_each_row(height, [&](int y) {
    for_each_run_in_row(tiles, width, y, [&](scheduler::Range columns) {
      kernels::take_filled_medians_row(
          {.disparity_px = inside(work.before, y) + columns.begin,
           .disparity_pitch = static_cast<std::ptrdiff_t>(work.before.view().stride()),
           .pixels = inside(work.pixels, y) + columns.begin * kernels::kFilledPixelBytes,
           .pixel_pitch = static_cast<std::ptrdiff_t>(work.pixels.view().stride()),
           .unmatched = unmatched.row(y) + columns.begin,
           .width = columns.size(),
           .grid = grid},
          map_px.row(y) + columns.begin);
    });
  });
}

}  // namespace vantage
