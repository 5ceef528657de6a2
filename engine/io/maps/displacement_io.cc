#include "engine/io/maps/displacement_io.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/maps/map_formats.h"

namespace vantage {

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
