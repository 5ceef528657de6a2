#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/scene_graph/scene_builder.h"

namespace vantage {

/// Parses a list of images and camera positions: lines image,x,y (CsvRecords), with or without that
/// heading. Relative names are relative to the folder of `file`. Throws Error naming `file` and the
/// line.
std::vector<SceneImage> parse_position_list(std::string_view text,
                                            const std::filesystem::path& file);

/// parse_position_list() of a file. Throws Error, also when it cannot be read.
std::vector<SceneImage> read_position_list(const std::filesystem::path& file);

}  // namespace vantage
