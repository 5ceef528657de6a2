#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/evaluation/benchmark_folder.h"
#include "engine/options/setting_value.h"

namespace vantage::apps {

using ReadMap = std::function<DisparityMap(const std::filesystem::path& file)>;

/// The scores of all scenes whose maps are there, as rows of a report: scene, region, map, counts
/// of pixels and kScoreColumns, null where there is none. Region after region, then for each region
/// the "mean" of the scenes, and the shares and the average of "all pixels" of all scenes. Throws
/// Error naming the map that does not fit.
SettingValue score_folder(const BenchmarkFolder& folder, const ReadMap& read, double truth_scale,
                          int ignore_border_px);

/// The rows as lines of text, and as CSV.
std::string score_table(const SettingValue& rows);
std::string score_csv(const SettingValue& rows);

}  // namespace vantage::apps
