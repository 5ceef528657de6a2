#pragma once

#include <filesystem>
#include <vector>

#include "engine/execution.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Markdown: PSNR and SSIM of views between the cameras against the photographs taken there, from
/// true maps and from those of each contender, in the mean over the scenes of each group and by
/// scene. Of `scenes`, those that view_scenes() has.
void print_view_tables(const std::vector<MapContender>& contenders,
                       const std::vector<const TrueScene*>& scenes,
                       const std::filesystem::path& data, Execution& execution);

}  // namespace vantage::perf
