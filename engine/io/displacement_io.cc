#include "engine/io/displacement_io.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/atomic_file.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/npy.h"

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr float kFloUnknown = 1e10F;

/// (u, v) interleaved; both `unknown` where one of them is not finite.
Image<float> interleaved(const DisplacementView& displacements, Side side, float unknown) {
  const float sign = side == Side::kLeft ? -1.0F : 1.0F;
  const int width = displacements.x_px.width();
  Image<float> result(width, displacements.x_px.height(), 2);
  for (int y = 0; y < result.height(); ++y) {
    const float* along_x = displacements.x_px.row(y);
    const float* along_y = displacements.y_px.row(y);
    float* target = result.row(y);
    for (int x = 0; x < width; ++x) {
      const bool known = std::isfinite(along_x[x]) && std::isfinite(along_y[x]);
      // Plus zero: the partner of disparity 0 is not at −0.
      target[2 * x] = known ? sign * along_x[x] + 0.0F : unknown;
      target[2 * x + 1] = known ? sign * along_y[x] + 0.0F : unknown;
    }
  }
  return result;
}

std::vector<std::uint8_t> encode_flo(const Image<float>& interleaved) {
  constexpr std::size_t kHeaderBytes = 12;
  const std::size_t row_bytes = 2 * sizeof(float) * static_cast<std::size_t>(interleaved.width());
  std::vector<std::uint8_t> bytes(kHeaderBytes +
                                  row_bytes * static_cast<std::size_t>(interleaved.height()));
  const std::int32_t size[2] = {interleaved.width(), interleaved.height()};
  std::memcpy(bytes.data(), "PIEH", 4);
  std::memcpy(bytes.data() + 4, size, sizeof size);
  for (int y = 0; y < interleaved.height(); ++y) {
    std::memcpy(bytes.data() + kHeaderBytes + row_bytes * static_cast<std::size_t>(y),
                interleaved.row(y), row_bytes);
  }
  return bytes;
}

/// Three channels, as the picture formats have no two.
Image<float> with_validity(const Image<float>& interleaved) {
  Image<float> result(interleaved.width(), interleaved.height(), 3);
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      const bool known = !std::isnan(interleaved.at(x, y, 0));
      result.at(x, y, 0) = known ? interleaved.at(x, y, 0) : 0;
      result.at(x, y, 1) = known ? interleaved.at(x, y, 1) : 0;
      result.at(x, y, 2) = known ? 1.0F : 0.0F;
    }
  }
  return result;
}

}  // namespace

void write_displacements(const std::filesystem::path& path, const DisplacementView& displacements,
                         Side side) {
  if (!is_displacement_extension(path)) {
    throw UsageError(fmt::format(
        "cannot write {}: '{}' cannot hold displacements of two components, expected .flo .npy "
        ".tiff or .exr",
        path.string(), path.extension().string()));
  }
  if (displacements.x_px.empty() || displacements.x_px.width() != displacements.y_px.width() ||
      displacements.x_px.height() != displacements.y_px.height()) {
    throw Error(
        fmt::format("cannot write {}: expected two components of one size, at least 1x1 pixels",
                    path.string()));
  }
  const std::string extension = lower_case_extension(path);
  if (extension == ".flo") {
    write_binary_file(path, encode_flo(interleaved(displacements, side, kFloUnknown)));
    return;
  }
  const Image<float> values =
      interleaved(displacements, side, std::numeric_limits<float>::quiet_NaN());
  if (extension == ".npy") {
    write_binary_file(path, encode_npy(values.view()));
  } else {
    std::vector<std::uint8_t> bytes;
    encode_image(path, Photograph{with_validity(values)}, bytes);
    write_binary_file(path, bytes);
  }
}

bool is_displacement_extension(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  return extension == ".flo" || extension == ".npy" || extension == ".tiff" ||
         extension == ".tif" || extension == ".exr";
}

}  // namespace vantage
