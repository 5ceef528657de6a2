#pragma once

#include <filesystem>
#include <vector>

#include "engine/execution.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Prints Markdown: PSNR and SSIM of views between the cameras against photographs taken there,
/// from true maps and from each contender's maps, averaged over the scenes of each group and per
/// scene. Uses those of `scenes` that view_scenes() has.
void print_view_tables(const std::vector<MapContender>& contenders,
                       const std::vector<const TrueScene*>& scenes,
                       const std::filesystem::path& data, Execution& execution);

}  // namespace vantage::perf
