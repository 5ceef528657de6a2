#include "engine/io/disparity_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/error.h"
#include "engine/io/atomic_file.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/npy.h"
#include "engine/io/pfm.h"

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kKittiScale = 256;
constexpr double kKittiMost = 65535;

template <typename Change>
Image<float> transformed(ImageView<const float> source, const Change& change) {
  Image<float> result(source.width(), source.height());
  for (int y = 0; y < source.height(); ++y) {
    std::transform(source.row(y), source.row(y) + source.width(), result.row(y), change);
  }
  return result;
}

Image<float> with_unknown_as(ImageView<const float> source, float unknown) {
  return transformed(source, [=](float d) { return std::isfinite(d) ? d : unknown; });
}

template <typename T>
DisparityMap from_integers(const Image<T>& image, double scale) {
  DisparityMap map(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const T value = image.at(x, y);
      map.at(x, y) = value == 0 ? kUnknown : static_cast<float>(value / scale);
    }
  }
  return map;
}

Image<std::uint16_t> to_kitti(const std::filesystem::path& path, ImageView<const float> disparity) {
  Image<std::uint16_t> image(disparity.width(), disparity.height());
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const float d = disparity.at(x, y);
      if (!std::isfinite(d)) {
        image.at(x, y) = 0;
        continue;
      }
      const double stored = std::round(d * kKittiScale);
      if (stored < 0 || stored > kKittiMost) {
        throw Error(fmt::format(
            "cannot write {}: disparity {} at pixel ({}, {}) does not fit a 16-bit PNG, expected "
            "0..255.99 (.pfm, .tiff, .exr and .npy hold any)",
            path.string(), d, x, y));
      }
      // 0 means unknown, so what is known is stored as the nearest there is.
      image.at(x, y) = static_cast<std::uint16_t>(std::max(stored, 1.0));
    }
  }
  return image;
}

}  // namespace

DisparityMap read_disparity(const std::filesystem::path& path, double scale) {
  if (!(scale >= 0) || !std::isfinite(scale)) {
    throw UsageError(fmt::format("disparity scale is {}, expected a number above 0", scale));
  }
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const FileBytes file(bytes, path.string());
  if (is_npy(file)) {
    return with_unknown_as(decode_npy(file).view(), kUnknown);
  }
  const bool is_png = file.has_at(0, "\x89PNG");
  const DecodedImage stored = decode_image(file);
  if (stored.photograph.channels() != 1) {
    file.fail(fmt::format("has {} channels, expected a disparity map of 1",
                          stored.photograph.channels()));
  }
  return std::visit(
      [&]<typename T>(const Image<T>& image) -> DisparityMap {
        if constexpr (std::is_same_v<T, float>) {
          return with_unknown_as(image.view(), kUnknown);
        } else {
          const bool has_default = is_png && sizeof(T) == 2;
          if (scale == 0 && !has_default) {
            file.fail("holds integers, expected a scale to divide them by (16-bit PNG has 256)");
          }
          return from_integers(image, scale > 0 ? scale : kKittiScale);
        }
      },
      stored.photograph.pixels);
}

void encode_disparity(const std::filesystem::path& path, ImageView<const float> disparity,
                      std::vector<std::uint8_t>& bytes) {
  if (!is_disparity_extension(path)) {
    throw UsageError(fmt::format(
        "cannot write {}: unknown disparity extension '{}', expected .pfm .png .tiff .exr or .npy",
        path.string(), path.extension().string()));
  }
  if (disparity.empty() || disparity.channels() != 1) {
    throw Error(
        fmt::format("cannot write {}: expected a disparity map of at least 1x1 pixels and "
                    "one channel",
                    path.string()));
  }
  const std::string extension = lower_case_extension(path);
  if (extension == ".pfm") {
    encode_pfm(disparity, bytes, std::numeric_limits<float>::infinity());
  } else if (extension == ".npy") {
    bytes = encode_npy(with_unknown_as(disparity, kUnknown).view());
  } else if (extension == ".png") {
    encode_image(path, Photograph{to_kitti(path, disparity)}, bytes);
  } else {
    encode_image(path, Photograph{with_unknown_as(disparity, kUnknown)}, bytes);
  }
}

void write_disparity(const std::filesystem::path& path, ImageView<const float> disparity) {
  std::vector<std::uint8_t> bytes;
  encode_disparity(path, disparity, bytes);
  write_binary_file(path, bytes);
}

void require_holds_search(const std::filesystem::path& path, int least_px, int most_px) {
  if (lower_case_extension(path) == ".png" &&
      (least_px < 0 || most_px * kKittiScale > kKittiMost)) {
    throw UsageError(
        fmt::format("{} is a 16-bit PNG, which holds disparities from 0 to 255.99, but {}:{} are "
                    "searched; expected .pfm, .tiff, .exr or .npy, which hold any, or "
                    "--disparities MIN:MAX within 0:255",
                    path.string(), least_px, most_px));
  }
}

bool is_disparity_extension(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  return extension == ".pfm" || extension == ".png" || extension == ".tiff" ||
         extension == ".tif" || extension == ".exr" || extension == ".npy";
}

}  // namespace vantage
