#include "engine/image/pixel_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "kernels/colour_order/colour_order.h"

namespace vantage {
namespace {

// Widths of images of files end here, too; sums of positions stay far from the limits of int.
constexpr int kMaxSidePx = 65500;

/// The buffer with all distances.
template <typename T>
PixelBuffer<T> complete(PixelBuffer<T> buffer) {
  const auto or_next = [](std::ptrdiff_t& distance, std::ptrdiff_t next) {
    distance = distance == 0 ? next : distance;
  };
  or_next(buffer.channel_bytes, sizeof(T));
  or_next(buffer.pixel_bytes, buffer.channels * static_cast<std::ptrdiff_t>(sizeof(T)));
  or_next(buffer.row_bytes, buffer.width_px * buffer.pixel_bytes);
  return buffer;
}

/// Whether rows are arrays of T without gaps.
template <typename T>
bool has_whole_rows(const PixelBuffer<T>& buffer) {
  constexpr auto kBytes = static_cast<std::ptrdiff_t>(sizeof(T));
  return (buffer.channels == 1 || buffer.channel_bytes == kBytes) &&
         (buffer.pixel_bytes == buffer.channels * kBytes || buffer.width_px == 1) &&
         (buffer.height_px == 1 || buffer.row_bytes % kBytes == 0) &&
         reinterpret_cast<std::uintptr_t>(buffer.data) % alignof(T) == 0;
}

template <typename T>
bool is_reversed(const PixelBuffer<T>& buffer) {
  return buffer.order == ChannelOrder::kBgr && buffer.channels >= 3;
}

template <typename T>
bool is_like_image(const PixelBuffer<T>& buffer) {
  const auto row_bytes = static_cast<std::ptrdiff_t>(sizeof(T)) * buffer.width_px * buffer.channels;
  return has_whole_rows(buffer) && !is_reversed(buffer) &&
         (buffer.height_px == 1 || buffer.row_bytes >= row_bytes);
}

/// Throws Error for infinity.
template <typename T>
bool has_nan(const Image<T>& image) {
  bool has_any = false;
  if constexpr (std::is_floating_point_v<T>) {
    const int values = image.width() * image.channels();
    for (int y = 0; y < image.height(); ++y) {
      for (int i = 0; i < values; ++i) {
        const T value = image.row(y)[i];
        if (std::isinf(value)) {
          throw Error(
              fmt::format("the image is {} at pixel ({}, {}), expected finite values or NaN", value,
                          i / image.channels(), y));
        }
        has_any = has_any || std::isnan(value);
      }
    }
  }
  return has_any;
}

template <typename T>
Photograph copy_of(const PixelBuffer<T>& buffer) {
  Image<T> image(buffer.width_px, buffer.height_px, buffer.channels);
  const bool reverses = is_reversed(buffer);
  const bool is_whole = has_whole_rows(buffer);
  const auto* const first = reinterpret_cast<const std::byte*>(buffer.data);
  for (int y = 0; y < buffer.height_px; ++y) {
    const std::byte* const row = first + y * buffer.row_bytes;
    T* out = image.row(y);
    if (is_whole && !reverses) {
      std::copy_n(reinterpret_cast<const T*>(row), buffer.width_px * buffer.channels, out);
      continue;
    }
    if (is_whole && buffer.channels == 3) {
      kernels::opposite_colour_order_row(reinterpret_cast<const T*>(row), buffer.width_px, out);
      continue;
    }
    for (int x = 0; x < buffer.width_px; ++x) {
      const std::byte* const pixel = row + x * buffer.pixel_bytes;
      for (int c = 0; c < buffer.channels; ++c) {
        const int from = reverses && c < 3 ? 2 - c : c;
        std::memcpy(out++, pixel + from * buffer.channel_bytes, sizeof(T));
      }
    }
  }
  const bool has_gaps = has_nan(image);
  Photograph photograph{std::move(image)};
  if (has_gaps) {
    leave_out_no_data(photograph);
  }
  return photograph;
}

}  // namespace

template <typename T>
void check_pixel_buffer(const PixelBuffer<T>& buffer) {
  if (buffer.width_px < 1 || buffer.height_px < 1 || buffer.width_px > kMaxSidePx ||
      buffer.height_px > kMaxSidePx) {
    throw Error(fmt::format("the image has {}x{} pixels, expected 1 to {} columns and rows",
                            buffer.width_px, buffer.height_px, kMaxSidePx));
  }
  if (buffer.channels != 1 && buffer.channels != 3 && buffer.channels != 4) {
    throw Error(fmt::format(
        "the image has {} channels, expected 1 (grey), 3 (colours) or 4 (colours and alpha)",
        buffer.channels));
  }
  if (buffer.data == nullptr) {
    throw Error("the image has no pixels, expected a pointer to the upper left one");
  }
}

template <typename T>
Photograph photograph_of(const PixelBuffer<T>& given) {
  check_pixel_buffer(given);
  const PixelBuffer<T> buffer = complete(given);
  if (!is_like_image(buffer)) {
    return copy_of(buffer);
  }
  Image<T> image =
      Image<T>::borrowed({buffer.data, buffer.width_px, buffer.height_px, buffer.channels,
                          static_cast<std::size_t>(buffer.row_bytes) / sizeof(T)});
  return has_nan(image) ? copy_of(buffer) : Photograph{std::move(image)};
}

template <typename T>
Photograph copied_photograph(const PixelBuffer<T>& buffer) {
  check_pixel_buffer(buffer);
  return copy_of(complete(buffer));
}

template void check_pixel_buffer(const PixelBuffer<std::uint8_t>& buffer);
template void check_pixel_buffer(const PixelBuffer<std::uint16_t>& buffer);
template void check_pixel_buffer(const PixelBuffer<float>& buffer);
template Photograph photograph_of(const PixelBuffer<std::uint8_t>& buffer);
template Photograph photograph_of(const PixelBuffer<std::uint16_t>& buffer);
template Photograph photograph_of(const PixelBuffer<float>& buffer);
template Photograph copied_photograph(const PixelBuffer<std::uint8_t>& buffer);
template Photograph copied_photograph(const PixelBuffer<std::uint16_t>& buffer);
template Photograph copied_photograph(const PixelBuffer<float>& buffer);

}  // namespace vantage
