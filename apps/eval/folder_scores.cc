#include "apps/eval/folder_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "apps/eval/score_columns.h"
#include "apps/reports/text_table.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

SettingValue row_of(const std::string& scene, const std::string& map, const RegionScores& region) {
  SettingValue row = {{"scene", scene},
                      {"region", region.region},
                      {"map", map},
                      {"evaluated_pixels", region.scores.evaluated_pixels},
                      {"valid_pixels", region.scores.valid_pixels}};
  for (const ScoreColumn& column : kScoreColumns) {
    const double value = region.scores.*column.value;
    row[std::string(column.key)] = std::isfinite(value) ? SettingValue(value) : SettingValue();
  }
  return row;
}

/// The mean of the scenes; `by_pixels`: of their pixels, of which medians and such are not known.
DisparityScores total_of(const std::vector<DisparityScores>& scenes, bool by_pixels) {
  DisparityScores total;
  for (const DisparityScores& one : scenes) {
    total.evaluated_pixels += one.evaluated_pixels;
    total.valid_pixels += one.valid_pixels;
  }
  for (const ScoreColumn& column : kScoreColumns) {
    double sum = 0;
    double weights = 0;
    for (const DisparityScores& one : scenes) {
      const auto pixels = column.is_share() ? one.evaluated_pixels : one.valid_pixels;
      const double weight = by_pixels ? static_cast<double>(pixels) : 1;
      sum += weight > 0 ? weight * one.*column.value : 0;
      weights += weight;
    }
    const bool adds_up = !by_pixels || column.is_share() || column.key == "average_px";
    total.*column.value = adds_up ? sum / weights : std::numeric_limits<double>::quiet_NaN();
  }
  return total;
}

}  // namespace

SettingValue score_folder(const BenchmarkFolder& folder, const ReadMap& read, double truth_scale,
                          int ignore_border_px) {
  SettingValue rows = SettingValue::array();
  std::vector<std::pair<std::string, std::vector<DisparityScores>>> regions;
  for (const BenchmarkScene& scene : folder.scenes) {
    if (scene.map.empty()) {
      continue;
    }
    try {
      const DisparityMap map = read(scene.map);
      for (const RegionScores& scores :
           evaluate_scene(scene, map.view(), truth_scale, ignore_border_px)) {
        rows.push_back(row_of(scene.name, scene.map.string(), scores));
        auto of_region = std::ranges::find(regions, scores.region,
                                           [](const auto& region) { return region.first; });
        if (of_region == regions.end()) {
          of_region = regions.insert(of_region, {scores.region, {}});
        }
        of_region->second.push_back(scores.scores);
      }
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", scene.map.string(), error.what()));
    }
  }
  for (const auto& [region, scenes] : regions) {
    rows.push_back(row_of("mean", "", {region, total_of(scenes, false)}));
    rows.push_back(row_of("all pixels", "", {region, total_of(scenes, true)}));
  }
  return rows;
}

std::string score_table(const SettingValue& rows) {
  std::vector<std::string> heads = {"scene", "region", "pixels"};
  for (const ScoreColumn& column : kScoreColumns) {
    heads.emplace_back(column.label);
  }
  TextTable table("errors in % and px", std::move(heads));
  for (const SettingValue& row : rows) {
    std::vector<std::string> cells = {row["scene"].get<std::string>(),
                                      row["region"].get<std::string>(),
                                      row["evaluated_pixels"].dump()};
    for (const ScoreColumn& column : kScoreColumns) {
      const SettingValue& value = row[std::string(column.key)];
      cells.push_back(value.is_null() ? "-" : fmt::format("{:.2f}", value.get<double>()));
    }
    table.add(std::move(cells));
  }
  return table.text();
}

std::string score_csv(const SettingValue& rows) {
  std::string text;
  for (const auto& [key, value] : rows.at(0).items()) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", key);
  }
  for (const SettingValue& row : rows) {
    std::string fields;
    for (const SettingValue& value : row) {
      fields += fmt::format("{}{}", fields.empty() ? "\n" : ",",
                            value.is_null() ? std::string() : value.dump());
    }
    text += fields;
  }
  return text + "\n";
}

}  // namespace vantage::apps
