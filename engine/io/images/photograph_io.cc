#include "engine/io/images/photograph_io.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>
#include <utility>

#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/image_file.h"

namespace vantage {
namespace {

void check_finite(const FileBytes& file, const Image<float>& image) {
  for (int y = 0; y < image.height(); ++y) {
    const float* row = image.row(y);
    for (int i = 0; i < image.width() * image.channels(); ++i) {
      if (!std::isfinite(row[i])) {
        file.fail(fmt::format("its value at pixel ({}, {}) is {}, expected finite values",
                              i / image.channels(), y, row[i]));
      }
    }
  }
}

/// PNM files may define white as 1023, for example: photographs use the full range of their type.
template <typename T>
void stretch(Image<T>& image, unsigned max_value) {
  constexpr unsigned kFull = sizeof(T) == 1 ? 255U : 65535U;
  if (max_value == kFull) {
    return;
  }
  for (int y = 0; y < image.height(); ++y) {
    T* row = image.row(y);
    for (int i = 0; i < image.width() * image.channels(); ++i) {
      row[i] = static_cast<T>((row[i] * kFull + max_value / 2) / max_value);
    }
  }
}

}  // namespace

Photograph read_photograph(const std::filesystem::path& path, Photograph memory) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const FileBytes file(bytes, path.string());
  DecodedImage stored = decode_image(file, std::move(memory));
  std::visit(
      [&]<typename T>(Image<T>& image) {
        if constexpr (std::is_same_v<T, float>) {
          check_finite(file, image);
        } else {
          stretch(image, static_cast<unsigned>(stored.max_value));
        }
      },
      stored.photograph.pixels);
  return std::move(stored.photograph);
}

void encode_photograph(const std::filesystem::path& path, const Photograph& photograph,
                       std::vector<std::uint8_t>& bytes) {
  encode_image(path, photograph, bytes);
}

void write_photograph(const std::filesystem::path& path, const Photograph& photograph) {
  std::vector<std::uint8_t> bytes;
  encode_image(path, photograph, bytes);
  write_binary_file(path, bytes);
}

void write_mask(const std::filesystem::path& path, ImageView<const std::uint8_t> mask) {
  if (lower_case_extension(path) != ".png") {
    throw UsageError(fmt::format("cannot write {}: a mask is a .png file", path.string()));
  }
  write_photograph(path, Photograph{Image<std::uint8_t>::copy_of(mask)});
}

}  // namespace vantage
