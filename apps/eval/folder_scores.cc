#include "apps/eval/folder_scores.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "apps/eval/score_columns.h"
#include "apps/reports/text_table.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

void add_totals(std::vector<ScoreRow>& rows) {
  std::vector<std::string> regions;
  std::map<std::string, std::vector<DisparityScores>> scores;
  for (const ScoreRow& row : rows) {
    std::vector<DisparityScores>& of_region = scores[row.scores.region];
    if (of_region.empty()) {
      regions.push_back(row.scores.region);
    }
    of_region.push_back(row.scores.scores);
  }
  for (const std::string& region : regions) {
    DisparityScores mean;
    DisparityScores pixels;
    for (const DisparityScores& one : scores[region]) {
      mean.evaluated_pixels += one.evaluated_pixels;
      mean.valid_pixels += one.valid_pixels;
    }
    pixels = mean;
    for (const ScoreColumn& column : kScoreColumns) {
      const bool adds_up = column.is_share() || column.key == "average_px";
      double sum = 0;
      double weighted_sum = 0;
      double weight_sum = 0;
      for (const DisparityScores& one : scores[region]) {
        const auto weight =
            static_cast<double>(column.is_share() ? one.evaluated_pixels : one.valid_pixels);
        sum += one.*column.value;
        weighted_sum += weight > 0 ? weight * one.*column.value : 0;
        weight_sum += weight;
      }
      mean.*column.value = sum / static_cast<double>(scores[region].size());
      pixels.*column.value =
          adds_up ? weighted_sum / weight_sum : std::numeric_limits<double>::quiet_NaN();
    }
    rows.push_back({"mean", "", {region, mean}});
    rows.push_back({"all pixels", "", {region, pixels}});
  }
}

}  // namespace

std::vector<ScoreRow> score_folder(const BenchmarkFolder& folder, const ReadSceneMap& read,
                                   double truth_scale, int ignore_border_px) {
  std::vector<ScoreRow> rows;
  for (const BenchmarkScene& scene : folder.scenes) {
    if (const std::optional<SceneMap> map = read(scene.name)) {
      try {
        for (RegionScores& scores :
             evaluate_scene(scene, map->disparity_px.view(), truth_scale, ignore_border_px)) {
          rows.push_back({scene.name, map->file, std::move(scores)});
        }
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", map->file, error.what()));
      }
    }
  }
  add_totals(rows);
  return rows;
}

std::string score_table(const std::vector<ScoreRow>& rows) {
  std::vector<std::string> heads = {"scene", "region", "pixels"};
  for (const ScoreColumn& column : kScoreColumns) {
    heads.emplace_back(column.label);
  }
  TextTable table("errors in % and px", std::move(heads));
  for (const ScoreRow& row : rows) {
    const DisparityScores& scores = row.scores.scores;
    std::vector<std::string> cells = {row.scene, row.scores.region,
                                      std::to_string(scores.evaluated_pixels)};
    for (const ScoreColumn& column : kScoreColumns) {
      const double value = scores.*column.value;
      cells.push_back(std::isfinite(value) ? fmt::format("{:.2f}", value) : "-");
    }
    table.add(std::move(cells));
  }
  return table.text();
}

std::string score_csv(const std::vector<ScoreRow>& rows) {
  std::string text = "scene,region,map,evaluated_pixels,valid_pixels";
  for (const ScoreColumn& column : kScoreColumns) {
    text += fmt::format(",{}", column.key);
  }
  for (const ScoreRow& row : rows) {
    const DisparityScores& scores = row.scores.scores;
    text += fmt::format("\n{},{},\"{}\",{},{}", row.scene, row.scores.region, row.map,
                        scores.evaluated_pixels, scores.valid_pixels);
    for (const ScoreColumn& column : kScoreColumns) {
      const double value = scores.*column.value;
      text += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",";
    }
  }
  return text + "\n";
}

SettingValue score_values(const std::vector<ScoreRow>& rows) {
  SettingValue values = SettingValue::array();
  for (const ScoreRow& row : rows) {
    const DisparityScores& scores = row.scores.scores;
    SettingValue one = {{"scene", row.scene},
                        {"region", row.scores.region},
                        {"map", row.map},
                        {"evaluated_pixels", scores.evaluated_pixels},
                        {"valid_pixels", scores.valid_pixels}};
    for (const ScoreColumn& column : kScoreColumns) {
      one[std::string(column.key)] = scores.*column.value;
    }
    values.push_back(std::move(one));
  }
  return values;
}

}  // namespace vantage::apps
