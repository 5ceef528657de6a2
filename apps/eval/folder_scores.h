#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/benchmark_folder.h"
#include "engine/options/setting_value.h"

namespace vantage::apps {

/// A map of a scene, and the name of its file.
struct SceneMap {
  DisparityMap disparity_px;
  std::string file;
};
/// Reads the map of a scene; empty: it is missing.
using ReadSceneMap = std::function<std::optional<SceneMap>(const std::string& scene)>;

/// Scores of a region of a scene, or of all scenes together.
struct ScoreRow {
  std::string scene;  ///< "mean": of the scenes; "all pixels": of the pixels of all scenes
  std::string map;    ///< file; empty for all scenes
  RegionScores scores;
};

/// The scores of all scenes whose maps are there, region after region, then for each region the
/// mean of the scenes, and the shares and the average over the pixels of all scenes (its other
/// scores are NaN). Throws Error naming the map that does not fit.
std::vector<ScoreRow> score_folder(const BenchmarkFolder& folder, const ReadSceneMap& read,
                                   double truth_scale, int ignore_border_px);

/// As lines of text, as CSV, and for the report; "-", an empty field and null where there is none.
std::string score_table(const std::vector<ScoreRow>& rows);
std::string score_csv(const std::vector<ScoreRow>& rows);
SettingValue score_values(const std::vector<ScoreRow>& rows);

}  // namespace vantage::apps
