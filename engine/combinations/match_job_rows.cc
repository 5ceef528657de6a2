#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "engine/combinations/combination_rows.h"

// What does not go together in `vantage match`.

namespace vantage {
namespace {

constexpr CombinationScope kMatchJob = CombinationScope::kMatchJob;

/// "--OPTION cannot be used with WITH: REASON".
void refuse_with(std::vector<Combination>& rows, const Condition& option, std::string_view shown,
                 const std::vector<Condition>& with, std::string_view shown_with,
                 std::string_view reason) {
  add_refused(rows, kMatchJob, option, with, reason,
              fmt::format("--{} cannot be used with {}: {}", shown, shown_with, reason));
}

void add_unrectified_match(std::vector<Combination>& rows) {
  const Condition unrectified = given("unrectified");
  add_idle_unrectified(rows, kMatchJob);
  add_idle_with(rows, kMatchJob, {"tuning", "no-tuning"}, unrectified,
                "with --unrectified: tuning is for rectified pairs");
  add_idle_with(rows, kMatchJob, {"no-rectification-check"}, unrectified, "with --unrectified");
  const auto refuse = [&](const Condition& option, std::string_view shown,
                          std::string_view reason) {
    refuse_with(rows, option, shown, {unrectified}, "--unrectified", reason);
  };
  constexpr std::string_view kDepths =
      "depths belong to rectified pixels, which --calibration alone makes";
  constexpr std::string_view kFractions = "candidates differ by fractions from pixel to pixel";
  constexpr std::string_view kMoments = "posterior-mean and --posterior-variance";
  refuse(given("baselines"), "baselines", "a calibration is of two cameras");
  refuse(given("more"), "baselines", "a calibration is of two cameras");
  refuse(given("vertical"), "vertical", "the calibration says where the cameras are");
  refuse(given("disparities-y"), "disparities-y", "epipolar lines are known");
  refuse(is("selection", "symmetric"), "selection symmetric",
         "pixels of both photographs lie on different epipolar lines");
  refuse(given("calibration"), "calibration", kDepths);
  refuse(given("focal-length"), "focal-length", kDepths);
  refuse(given("volume"), "volume", kFractions);
  refuse(given("posterior-mean"), kMoments, kFractions);
  refuse(given("posterior-variance"), kMoments, kFractions);
}

void add_maps_of_several(std::vector<Combination>& rows) {
  const std::vector<Condition> several = {given("baselines"), given("more")};
  add_several(rows, kMatchJob);
  refuse_with(rows, is("reference", "right"), "reference right", several, "--baselines",
              "the first image is the reference");
  refuse_with(rows, given("output-right"), "output-right", several, "--baselines",
              "only the first image has a map");
  refuse_with(rows, given("unmatched-right"), "unmatched-right", several, "--baselines",
              "only the first image has a map");
  refuse_with(rows, given("disparities-y"), "disparities-y", several, "--baselines",
              "cameras on one line have no vertical disparities");
}

void add_match_outputs(std::vector<Combination>& rows) {
  refuse_with(rows, given("output-right"), "output-right", {is("reference", "right")},
              "--reference right", "--output belongs to the right map");
  refuse_with(rows, given("unmatched-right"), "unmatched-right", {is("reference", "right")},
              "--reference right", "--unmatched belongs to the right map");
  add_idle_with(rows, kMatchJob, {"tuning"}, given("no-tuning"), "with --no-tuning");
  add_idle(rows, kMatchJob, {"disparity-resolution"}, {given("depth-resolution"), given("report")},
           "without --depth-resolution and --report");
  add_idle(rows, kMatchJob, {"kept-outline"}, {given("calibration")}, "without --calibration");
  add_idle(rows, kMatchJob, {"kitti-cameras"}, {given("calibration"), given("unrectified")},
           "without --calibration");
  add_idle(rows, kMatchJob, {"volume-kind", "volume-level", "volume-rows"}, {given("volume")},
           "without --volume");
  for (const std::string_view option : {"posterior-variance", "posterior-mean"}) {
    refuse_with(rows, given(option), option, {is_not("aggregate", "bayes")}, "{chosen}",
                "only the aggregation bayes has p(d)");
    refuse_with(rows, given(option), option, {given("disparities-y")}, "--disparities-y",
                "p is one of displacements");
  }
  for (const std::string_view option : {"cyclopean", "cyclopean-occlusion"}) {
    add_refused(rows, kMatchJob, given(option),
                {is_not("selection", "symmetric"), given("baselines"), given("more")},
                "others have no matches of both images",
                fmt::format("--{} is given, expected it with --selection symmetric only", option));
  }
}

}  // namespace

std::vector<Combination> match_job_combinations() {
  std::vector<Combination> rows;
  add_unrectified_match(rows);
  add_maps_of_several(rows);
  add_match_outputs(rows);
  return rows;
}

}  // namespace vantage
