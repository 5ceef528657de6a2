#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/displacement_view.h"
#include "engine/image/image.h"
#include "engine/image/side.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/maps/stored_map.h"

namespace vantage {

class Execution;

/// Content of a map file.
enum class MapContent {
  kDisparity,      ///< one component
  kDisplacements,  ///< both components
  kConfidence,     ///< floats of any range
  kDepth,          ///< metres
};

/// A file format of maps. To add one: a line in the table of map_formats.cc. Encoders write the
/// content of a file named `path` to `bytes`, whose memory is reused; sizes are checked before.
/// `execution`, which may be null, is for encode_png().
/// They throw Error naming `path` when the format cannot hold a value. Thread rule: may be called
/// concurrently.
struct MapFormat {
  std::string_view extension;  ///< lower case, with the dot
  bool is_listed = true;       ///< false: another spelling of a listed format
  /// Holds any float and unknown pixels; false: only 0 to kMaxIntegerDisparity, and unknown
  /// pixels.
  bool holds_any_value = true;
  /// Null: does not support maps of one component.
  void (*encode_disparity)(const std::filesystem::path& path, ImageView<const float> disparity,
                           std::vector<std::uint8_t>& bytes, Execution* execution) = nullptr;
  /// Null: does not support depths in metres, NaN = unknown.
  void (*encode_depth)(const std::filesystem::path& path, ImageView<const float> depth_m,
                       std::vector<std::uint8_t>& bytes, Execution* execution) = nullptr;
  /// Null: does not support maps of two components.
  void (*encode_displacements)(const std::filesystem::path& path,
                               const DisplacementView& displacements, Side side,
                               std::vector<std::uint8_t>& bytes) = nullptr;

  /// Whether a file has this format. Null: files of this format are read as images.
  bool (*recognizes)(const FileBytes& file) = nullptr;
  /// The values of a file that recognizes() accepts. Throws Error if the file is damaged, before it
  /// allocates memory for more than the file holds. Null where recognizes is null.
  StoredMap (*decode)(const FileBytes& file) = nullptr;

  [[nodiscard]] bool can_hold(MapContent content) const;
};

/// Steps per pixel of a 16-bit PNG, and its maximum value in steps.
constexpr double kIntegerDisparityScale = 256;
constexpr double kMaxIntegerDisparity = 65535;

/// Steps per metre of a depth in a 16-bit PNG; it holds depths up to 65.535 m.
constexpr double kIntegerDepthScale = 1000;
constexpr double kMaxIntegerDepth_m = 65535 / kIntegerDepthScale;

/// All formats, in the order of messages.
std::span<const MapFormat> map_formats();

/// The format given by the extension of `path`, in any letter case, if it can hold `content`; else
/// null.
const MapFormat* find_map_format(const std::filesystem::path& path, MapContent content);

/// The format of a file that is no image, by its content; else null.
const MapFormat* find_map_format(const FileBytes& file);

/// For messages: ".pfm, .png, .tiff, .exr or .npy". `prefix` replaces the dots.
std::string listed_map_formats(MapContent content, std::string_view prefix = ".");

}  // namespace vantage
