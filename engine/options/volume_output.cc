#include "engine/options/volume_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <utility>

#include "engine/error.h"
#include "engine/options/match_settings.h"

namespace vantage {
namespace {

constexpr std::array<std::pair<std::string_view, VolumeKind>, 2> kVolumeKinds = {
    {{"costs", VolumeKind::kCosts}, {"aggregated", VolumeKind::kAggregated}}};
constexpr const char* kAllRows = "all";

std::string_view content_name(VolumeContent content) {
  return content == VolumeContent::kProbabilities ? "probabilities" : "energies";
}

std::string text_of(VolumeRows rows) { return to_text(DisparityRange{rows.begin, rows.end - 1}); }

}  // namespace

void add_volume_settings(Settings& settings, VolumeOutput& output) {
  settings.path("volume", output.file, "FILE.npy",
                "Write the disparity space of the map's image: float32, rows x columns x "
                "candidates (with --disparities-y: x vertical x horizontal candidates), NaN where "
                "a candidate has no partner or was not searched; the report states the candidates");
  settings.choice<VolumeKind>(
      "volume-kind", output.kind, {kVolumeKinds.begin(), kVolumeKinds.end()},
      "With --volume: costs before aggregation (with bayes -ln of the likelihood), or what winners "
      "are selected from: energies, with bayes probabilities");
  settings.integer("volume-level", output.level, "N",
                   "With --volume and several levels: level of the coarse-to-fine search, 0 for "
                   "the full size");
  Setting& rows = settings.add("volume-rows", "FIRST:LAST",
                               "With --volume: write these rows of the level only, both ends "
                               "included; all: the whole volume");
  rows.kind = ValueKind::kRange;
  rows.words = {kAllRows};
  rows.set = [&output](const SettingValue& value) {
    if (value == kAllRows) {
      output.rows.reset();
      return;
    }
    const DisparityRange range =
        to_disparity_range(value, "FIRST:LAST in whole rows, such as 120:120, or all");
    output.rows = VolumeRows{range.min, range.max + 1};
  };
  rows.get = [&output]() -> SettingValue { return output.rows ? text_of(*output.rows) : kAllRows; };
}

void check_volume(const VolumeOutput& output, const MatchOptions& options) {
  if (output.file.empty()) {
    return;
  }
  const int levels = options.resolved().levels;
  if (output.level < 0 || output.level >= levels) {
    throw UsageError(fmt::format("--volume-level is {}, expected 0 to {}: there {} {} level{}",
                                 output.level, levels - 1, levels == 1 ? "is" : "are", levels,
                                 levels == 1 ? "" : "s"));
  }
  if (output.rows && (output.rows->begin < 0 || output.rows->begin >= output.rows->end)) {
    throw UsageError(fmt::format(
        "--volume-rows is {}, expected two rows from 0 on, the first not below the last",
        text_of(*output.rows)));
  }
}

void require_volume_rows(const VolumeOutput& output, int image_rows) {
  const int rows = ((image_rows - 1) >> output.level) + 1;  // levels are rounded up
  if (output.rows && output.rows->end > rows) {
    throw UsageError(fmt::format("--volume-rows is {}, expected rows within 0:{}",
                                 text_of(*output.rows), rows - 1));
  }
}

SettingValue volume_report(const VolumeOutput& output, const NpyVolumeFile& volume) {
  const VolumeShape& shape = volume.volume();
  SettingValue report = {{"file", output.file},
                         {"shape", volume.file_shape()},
                         {"values", content_name(shape.content)},
                         {"level", output.level},
                         {"rows", text_of(volume.rows())},
                         {"disparities", to_text(shape.disparities)},
                         {"candidate-step", 1.0 / shape.steps_per_px}};
  if (shape.disparities_y) {
    report["disparities-y"] = to_text(*shape.disparities_y);
  }
  return report;
}

std::string volume_summary(const VolumeOutput& output, const NpyVolumeFile& volume) {
  const VolumeShape& shape = volume.volume();
  const std::string_view values =
      output.kind == VolumeKind::kCosts ? std::string_view("costs") : content_name(shape.content);
  const std::string steps =
      shape.steps_per_px > 1 ? fmt::format(" in steps of {}", 1.0 / shape.steps_per_px) : "";
  return fmt::format("{} of disparities {}{}{}, {} -> {}", values, to_text(shape.disparities),
                     steps, shape.disparities_y ? " x " + to_text(*shape.disparities_y) : "",
                     fmt::join(volume.file_shape(), "x"), output.file);
}

}  // namespace vantage
