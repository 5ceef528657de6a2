#include "engine/io/maps/depth_io.h"

#include <fmt/format.h>

#include <limits>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/maps/map_formats.h"

namespace vantage {

void encode_depth(const std::filesystem::path& path, ImageView<const float> depth_m,
                  std::vector<std::uint8_t>& bytes) {
  const MapFormat* const format = find_map_format(path, MapContent::kDepth);
  if (format == nullptr) {
    throw UsageError(fmt::format("cannot write {}: unknown depth extension '{}', expected {}",
                                 path.string(), path.extension().string(),
                                 listed_map_formats(MapContent::kDepth)));
  }
  if (depth_m.empty() || depth_m.channels() != 1) {
    throw Error(
        fmt::format("cannot write {}: expected a depth map of at least 1x1 pixels and one channel",
                    path.string()));
  }
  format->encode_depth(path, depth_m, bytes);
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

}  // namespace vantage
