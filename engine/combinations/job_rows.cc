#include <fmt/format.h>

#include <initializer_list>
#include <string_view>
#include <vector>

#include "engine/combinations/combination_rows.h"

// What does not go together in the work of a command or of a loop over frames. Texts are those of
// the command line.

namespace vantage {
namespace {

using Scope = CombinationScope;

std::vector<Condition> saves(OptionNames outputs) {
  std::vector<Condition> conditions;
  for (const std::string_view output : outputs) {
    conditions.push_back(given(output));
  }
  return conditions;
}

void add_idle_views(std::vector<Combination>& rows) {
  add_idle(rows, Scope::kJob, {"stereo-views", "stereo-packing"}, {given("save stereo")},
           "where --save has no stereo");
  add_idle(rows, Scope::kJob,
           {"intensity-fit", "warp", "holes", "soft-edges", "gamma", "gradient-limit",
            "no-intensity-matching"},
           saves({"save views", "save holes", "save sources", "save stereo"}),
           "where --save has no views, holes, sources, stereo");
  add_idle_with(rows, Scope::kJob, {"gamma", "intensity-fit"}, given("no-intensity-matching"),
                "with --no-intensity-matching");
  add_idle(rows, Scope::kJob, {"temporal-threshold"},
           {above("temporal-prior", 0), is_not("reuse", "none")},
           "without --temporal-prior and --reuse");
}

void add_cameras(std::vector<Combination>& rows) {
  for (const std::string_view option : {"baselines", "more"}) {
    rows.push_back({.scope = Scope::kJob,
                    .option = given(option),
                    .only_with = {given("left"), given("resume")},
                    .reason = "they are of cameras beside those of left and right",
                    .message = "--baselines has no effect without --left and --right"});
  }
  add_several(rows, Scope::kJob);
  add_refused(rows, Scope::kJob, given("calibration"), {given("baselines"), given("more")},
              "it rectifies the images of two cameras only",
              "--calibration cannot be used with --baselines: it rectifies the images of two "
              "cameras only");
  add_idle_unrectified(rows, Scope::kJob);
  add_refused(rows, Scope::kJob, given("calibration"), {given("unrectified")},
              "both are of the cameras",
              "--calibration and --unrectified are both given, expected one of them: both are of "
              "the cameras");
  for (const Scope scope : {Scope::kJob, Scope::kPairList}) {
    rows.push_back({.scope = scope,
                    .option = above("kept-outline", 0),
                    .only_with = {given("calibration"), given("column calibration")},
                    .reason = "no effect",
                    .message = "--kept-outline has no effect without --calibration"});
    rows.push_back(
        {.scope = scope,
         .option = given("kitti-cameras"),
         .only_with = {given("calibration"), given("unrectified"), given("column calibration")},
         .reason = "no effect",
         .message = "--kitti-cameras has no effect without --calibration"});
  }
}

/// A list of pairs whose columns say something of each pair.
void add_pair_list(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& option, std::string_view column, std::string_view what,
                       std::string_view why) {
    rows.push_back({.scope = Scope::kPairList,
                    .option = option,
                    .with = {given(column)},
                    .reason = why,
                    .message = fmt::format("{} cannot be used with a list of pairs with the {}: {}",
                                           what, column, why)});
  };
  constexpr std::string_view kCalibration = "column calibration";
  constexpr std::string_view kRange = "column min-disparity";
  add(given("unrectified"), kCalibration, "--unrectified", "its file is of all pairs");
  for (const std::string_view output : {"view", "save stereo"}) {
    add(given(output), kCalibration, "--save views or stereo",
        "a view is defined by one pair of cameras");
  }
  add(above("temporal-prior", 0), kRange, "--temporal-prior",
      "disparities are passed from frame to frame");
  add(is_not("reuse", "none"), kRange, "--reuse", "disparities are passed from frame to frame");
  add(is("save depth-video", "of the search"), kRange,
      "--save depth-video without --depth-range MIN:MAX", "its levels stand for one range");
  add(is("search-range", "shot"), kRange, "--search-range shot",
      "the list has the ranges, expected --search-range film");
}

void add_idle_outputs(std::vector<Combination>& rows) {
  const std::vector<Condition> videos = {given("video"), given("save depth-video")};
  add_idle(rows, Scope::kRun, {"crf", "no-sound"}, videos, "without --video");
  add_idle(rows, Scope::kRun, {"fps"},
           {given("video"), given("save depth-video"), is("output", "-"), given("raw-video")},
           "without --video");
  add_idle(rows, Scope::kRun, {"depth-range", "depth-codec"}, {given("save depth-video")},
           "where --save has no depth-video");
  add_idle(
      rows, Scope::kRun, {"format"},
      saves({"save disparity", "save right-disparity", "save confidence", "save posterior-mean",
             "save posterior-variance", "save cyclopean", "save depth-resolution"}),
      "where --save has no disparity, right-disparity, confidence, posterior-mean, "
      "posterior-variance, cyclopean, depth-resolution");
  add_idle(rows, Scope::kRun, {"reference"},
           saves({"save disparity", "save confidence", "save unmatched", "save preview",
                  "save posterior-mean", "save posterior-variance", "save depth",
                  "save depth-resolution", "save cloud", "save mesh", "save depth-video",
                  "save comfort"}),
           "where --save has no disparity, confidence, unmatched, preview, posterior-mean, "
           "posterior-variance, depth, depth-resolution, cloud, mesh, depth-video, comfort");
  add_idle(rows, Scope::kRun, {"depth-format"}, {given("save depth")}, "where --save has no depth");
  add_idle(rows, Scope::kRun, {"disparity-resolution"}, {given("save depth-resolution")},
           "where --save has no depth-resolution");
  add_idle(rows, Scope::kRun,
           {"baseline", "focal-length", "principal-point", "doffs", "calibration-unit"},
           saves({"save depth", "save depth-resolution", "save cloud", "save mesh"}),
           "where --save has no depth, depth-resolution, cloud, mesh");
  add_idle(rows, Scope::kRun, {"max-depth"}, saves({"save depth", "save cloud", "save mesh"}),
           "where --save has no depth, cloud, mesh");
  add_idle(rows, Scope::kRun,
           {"cloud-step", "cloud-min-confidence", "cloud-confidence", "cloud-filled",
            "cloud-outlines", "cloud-gradient-limit", "poses"},
           saves({"save cloud", "save mesh"}), "where --save has no cloud, mesh");
  add_idle(rows, Scope::kRun, {"preview-range"}, {given("save preview")},
           "where --save has no preview");
}

/// Standard input and output are there once.
void add_streams(std::vector<Combination>& rows) {
  const Condition reads = is("stereo", "-");
  const Condition writes = is("output", "-");
  for (const std::string_view option : {"resume", "force"}) {
    add_refused(rows, Scope::kRun, given(option), {reads}, "standard input is read once",
                fmt::format("--{} is given, but the input is standard input, which cannot be read "
                            "again; --overwrite starts again",
                            option));
  }
  add_refused(rows, Scope::kRun, given("shard"), {reads}, "standard input is read once",
              "--shard is given and --stereo is -, expected a file: standard input is read once");
  for (const std::string_view option :
       {"search-range", "preview-range", "depth-range", "intensity-fit"}) {
    add_refused(rows, Scope::kRun, is(option, "shot"), {reads}, "it needs all frames of a shot",
                fmt::format("--{} is shot and --stereo is -, expected another value: it needs all "
                            "frames of a shot before the first; store the stream in a file",
                            option));
  }
  add_idle(rows, Scope::kRun, {"raw-video"}, {reads}, "without --stereo -");
  add_idle(rows, Scope::kRun, {"stream-format"}, {writes}, "without --output -");
  add_idle_with(rows, Scope::kRun,
                {"resume", "overwrite", "force", "shard", "video", "crf", "no-sound", "depth-codec",
                 "format"},
                writes, "with --output -");
}

void add_runs(std::vector<Combination>& rows) {
  add_refused(rows, Scope::kRun, is("search-range", "shot"), {given("disparities").set_by_user()},
              "the range is known",
              "search-range is shot, expected film with a range in --disparities");
  add_refused(rows, Scope::kRun, is("search-range", "shot").set_by_user(), {given("memory")},
              "memory is planned for one range",
              "search-range is shot, expected film with --memory, which plans for one range");
  add_refused(rows, Scope::kRun, is("search-range", "shot"), {given("memory")},
              "memory is planned for one range",
              "--memory plans for one range of disparities, but each shot of a film is searched in "
              "its own; expected --search-range film too, or a range in --disparities");
  add_idle_with(rows, Scope::kRun, {"tuning"}, given("no-tuning"), "with --no-tuning");
  add_idle_with(rows, Scope::kRun, {"tuning"}, given("memory"),
                "with --memory, for which the cost model plans");
  add_idle_with(rows, Scope::kRun, {"tuning", "no-tuning"}, given("unrectified"),
                "with --unrectified: tuning is for rectified pairs");
  add_idle_with(rows, Scope::kRun, {"no-rectification-check", "already-rectified"},
                given("unrectified"), "with --unrectified");
  for (const std::string_view option : {"resume", "force"}) {
    add_refused(rows, Scope::kRun, given("overwrite"), {given(option)}, "one replaces, one goes on",
                fmt::format("--overwrite and --{} are both given, expected one of them", option));
  }
  add_refused(
      rows, Scope::kRun, given("overwrite"), {given("shard")},
      "it would remove what other shards have done",
      "--overwrite with --shard would remove what other shards have done; remove the folder "
      "first, or use another one");
}

}  // namespace

std::vector<Combination> job_combinations() {
  std::vector<Combination> rows;
  add_idle_views(rows);
  add_cameras(rows);
  add_pair_list(rows);
  add_idle_outputs(rows);
  add_streams(rows);
  add_runs(rows);
  return rows;
}

}  // namespace vantage
