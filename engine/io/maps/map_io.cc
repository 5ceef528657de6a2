#include "engine/io/maps/map_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_formats.h"

namespace vantage {
namespace {

/// Of a file that holds a `what` map.
StoredMap read_stored(const FileBytes& file, const char* what) {
  if (const MapFormat* const format = find_map_format(file)) {
    return format->decode(file);
  }
  DecodedImage stored = decode_image(file);
  if (stored.photograph.channels() != 1) {
    file.fail(
        fmt::format("has {} channels, expected a {} map of 1", stored.photograph.channels(), what));
  }
  StoredMap map = std::visit(
      [&]<typename T>(Image<T>& image) -> StoredMap {
        if constexpr (std::is_same_v<T, float>) {
          return {.values = std::move(image),
                  .integer_bits = stored.integer_bits,
                  .is_signed = stored.integer_bits > 0};
        } else {
          StoredMap integers{.values = Image<float>(image.width(), image.height()),
                             .integer_bits = 8 * static_cast<int>(sizeof(T))};
          for (int y = 0; y < image.height(); ++y) {
            std::copy(image.row(y), image.row(y) + image.width(), integers.values.row(y));
          }
          integers.default_scale =
              sizeof(T) == 2 && file.has_at(0, "\x89PNG") ? kIntegerDisparityScale : 0;
          return integers;
        }
      },
      stored.photograph.pixels);
  for (int y = 0; stored.no_data && y < map.values.height(); ++y) {
    std::replace(map.values.row(y), map.values.row(y) + map.values.width(),
                 static_cast<float>(*stored.no_data), std::numeric_limits<float>::quiet_NaN());
  }
  return map;
}

void require_scale(double scale, const char* what) {
  if (!(scale >= 0) || !std::isfinite(scale)) {
    throw UsageError(fmt::format("{} scale is {}, expected a number above 0", what, scale));
  }
}

/// The format of a map of one component; what = "disparity" or "depth".
const MapFormat& format_of(const std::filesystem::path& path, ImageView<const float> map,
                           MapContent content, const char* what) {
  const MapFormat* const format = find_map_format(path, content);
  if (format == nullptr) {
    throw UsageError(fmt::format("cannot write {}: unknown {} extension '{}', expected {}",
                                 path.string(), what, path.extension().string(),
                                 listed_map_formats(content)));
  }
  if (map.empty() || map.channels() != 1) {
    throw Error(
        fmt::format("cannot write {}: expected a {} map of at least 1x1 pixels and one channel",
                    path.string(), what));
  }
  return *format;
}

}  // namespace

DisparityMap read_disparity(const std::filesystem::path& path, double scale,
                            std::vector<Remark>* remarks) {
  require_scale(scale, "disparity");
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const FileBytes file(bytes, path.string());
  return disparities_of(read_stored(file, "disparity"), scale, path.string(), remarks);
}

Image<float> read_depth(const std::filesystem::path& path, double scale,
                        std::vector<Remark>* remarks) {
  require_scale(scale, "depth");
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const FileBytes file(bytes, path.string());
  return depths_of(read_stored(file, "depth"), scale, path.string(), remarks);
}

Image<float> read_float_image(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const FileBytes file(bytes, path.string());
  const StoredMap stored = read_stored(file, "float");
  if (stored.integer_bits > 0) {
    file.fail("holds integers, expected floats");
  }
  return with_nan(stored.values.view());
}

void encode_disparity(const std::filesystem::path& path, ImageView<const float> disparity,
                      std::vector<std::uint8_t>& bytes, Execution* execution) {
  format_of(path, disparity, MapContent::kDisparity, "disparity")
      .encode_disparity(path, disparity, bytes, execution);
}

void write_disparity(const std::filesystem::path& path, ImageView<const float> disparity,
                     Execution* execution) {
  std::vector<std::uint8_t> bytes;
  encode_disparity(path, disparity, bytes, execution);
  write_binary_file(path, bytes);
}

void require_holds_search(const std::filesystem::path& path, int min_px, int max_px) {
  const MapFormat* const format = find_map_format(path, MapContent::kDisparity);
  if (format != nullptr && !format->holds_any_value &&
      (min_px < 0 || max_px * kIntegerDisparityScale > kMaxIntegerDisparity)) {
    throw UsageError(
        fmt::format("{} is a 16-bit PNG, which holds disparities from 0 to 255.99, but the search "
                    "range is {}:{}; expected {}, which have no limits, or `disparities` MIN:MAX "
                    "within 0:255",
                    path.string(), min_px, max_px, listed_map_formats(MapContent::kConfidence)));
  }
}

void encode_depth(const std::filesystem::path& path, ImageView<const float> depth_m,
                  std::vector<std::uint8_t>& bytes, Execution* execution) {
  format_of(path, depth_m, MapContent::kDepth, "depth")
      .encode_depth(path, depth_m, bytes, execution);
}

void write_depth(const std::filesystem::path& path, ImageView<const float> depth_m) {
  std::vector<std::uint8_t> bytes;
  encode_depth(path, depth_m, bytes);
  write_binary_file(path, bytes);
}

double largest_depth_m(const std::filesystem::path& path) {
  const MapFormat* const format = find_map_format(path, MapContent::kDepth);
  return format != nullptr && !format->holds_any_value ? kMaxIntegerDepth_m
                                                       : std::numeric_limits<double>::infinity();
}

void write_displacements(const std::filesystem::path& path, const DisplacementView& displacements,
                         Side side) {
  const MapFormat* const format = find_map_format(path, MapContent::kDisplacements);
  if (format == nullptr) {
    throw UsageError(fmt::format(
        "cannot write {}: '{}' cannot hold displacements of two components, expected {}",
        path.string(), path.extension().string(), listed_map_formats(MapContent::kDisplacements)));
  }
  if (displacements.x_px.empty() || displacements.x_px.width() != displacements.y_px.width() ||
      displacements.x_px.height() != displacements.y_px.height()) {
    throw Error(
        fmt::format("cannot write {}: expected two components of one size, at least 1x1 pixels",
                    path.string()));
  }
  std::vector<std::uint8_t> bytes;
  format->encode_displacements(path, displacements, side, bytes);
  write_binary_file(path, bytes);
}

}  // namespace vantage
