#include "engine/library/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/pixel_buffer.h"

namespace vantage {
namespace {

/// Refuses a struct that is smaller than the first version, or has set fields of a later one.
template <typename Struct>
void check_struct(const Struct* given, const char* name) {
  if (given == nullptr) {
    throw UsageError(fmt::format("{} is NULL, expected an address", name));
  }
  if (given->struct_size < sizeof(Struct) || given->struct_size > 16 * sizeof(Struct)) {
    throw UsageError(fmt::format("{}: struct_size is {}, expected sizeof the struct, {} or more",
                                 name, given->struct_size, sizeof(Struct)));
  }
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  if (given->reserved != 0 || std::any_of(bytes + sizeof(Struct), bytes + given->struct_size,
                                          [](unsigned char byte) { return byte != 0; })) {
    throw UsageError(fmt::format("{} has fields of a later version of the library than {}", name,
                                 VANTAGE_VERSION));
  }
}

template <typename T>
Photograph copy_of(const vantage_image& image) {
  return copied_photograph(
      PixelBuffer<T>{.data = static_cast<const T*>(image.pixels),
                     .width_px = image.width_px,
                     .height_px = image.height_px,
                     .channels = image.channels,
                     .row_bytes = image.row_bytes,
                     .order = image.is_bgr != 0 ? ChannelOrder::kBgr : ChannelOrder::kRgb});
}

/// Refuses a picture of another layout.
void check_layout(const vantage_picture& picture, int width, int height, int channels, int bits) {
  const auto address = reinterpret_cast<std::uintptr_t>(picture.pixels);
  if (address == 0 || address % (bits / 8) != 0 || picture.row_bytes % (bits / 8) != 0) {
    throw UsageError("pixels are NULL, or no multiple of a value away, expected whole values");
  }
  if (picture.width_px != width || picture.height_px != height || picture.channels != channels ||
      picture.bits != bits) {
    throw UsageError(fmt::format(
        "the picture has {}x{} pixels of {} channels of {} bits, expected {}x{} of {} of {}",
        picture.width_px, picture.height_px, picture.channels, picture.bits, width, height,
        channels, bits));
  }
}

template <typename T>
void write_pixels(const Image<T>& image, const vantage_picture& picture) {
  const int channels = image.channels();
  check_layout(picture, image.width(), image.height(), channels, 8 * static_cast<int>(sizeof(T)));
  const std::size_t values = static_cast<std::size_t>(image.width() * channels);
  const auto row_bytes =
      picture.row_bytes != 0 ? picture.row_bytes : static_cast<std::ptrdiff_t>(values * sizeof(T));
  for (int y = 0; y < image.height(); ++y) {
    auto* const row = reinterpret_cast<T*>(static_cast<std::byte*>(picture.pixels) + y * row_bytes);
    std::copy_n(image.row(y), values, row);
    for (int x = 0; picture.is_bgr != 0 && channels >= 3 && x < image.width(); ++x) {
      std::swap(row[x * channels], row[x * channels + 2]);
    }
  }
}

}  // namespace

Photograph photograph_of(const vantage_image* image, const char* name) {
  check_struct(image, name);
  try {
    switch (image->bits) {
      case 8:
        return copy_of<std::uint8_t>(*image);
      case 16:
        return copy_of<std::uint16_t>(*image);
      case 32:
        return copy_of<float>(*image);
      default:
        throw UsageError(fmt::format("bits are {}, expected 8, 16 or 32", image->bits));
    }
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", name, error.what()));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

void write_map(const Image<float>& map, const vantage_picture* picture) {
  check_struct(picture, "map");
  write_pixels(map, *picture);
}

void write_photograph(const Photograph& photograph, const vantage_picture* picture) {
  check_struct(picture, "view");
  std::visit([&](const auto& image) { write_pixels(image, *picture); }, photograph.pixels);
}

}  // namespace vantage
