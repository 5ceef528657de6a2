#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "engine/execution.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Where a page goes, and one that another build made, whose pictures are shown below its own.
struct PicturePage {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> before;
};

/// Writes FOLDER/index.html and its pictures: for each scene the photographs and the truth, and of
/// each contender the left map, its errors and new views at XS = -0.5, 0.5 and 1.5. Throws Error
/// for a file that cannot be written.
void write_picture_page(const std::vector<MapContender>& contenders,
                        const std::vector<const TrueScene*>& scenes,
                        const std::filesystem::path& data, const PicturePage& page,
                        Execution& execution);

}  // namespace vantage::perf
