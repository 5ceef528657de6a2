#include "apps/eval/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/json_text.h"
#include "engine/io/maps/map_io.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

bool wants_times(SubmissionKind kind) {
  return kind == SubmissionKind::kMiddlebury || kind == SubmissionKind::kEth3d;
}

/// Wall time per pair of a report.
double seconds_of(const std::string& path) {
  const SettingValue report = read_json_file(path);
  const auto number = [&](const char* place) {
    const SettingValue::json_pointer pointer(place);
    return report.contains(pointer) && report[pointer].is_number() ? report[pointer].get<double>()
                                                                   : 0;
  };
  const double wall = number("/seconds/wall");
  if (!(wall > 0)) {
    throw Error(fmt::format("{}: has no seconds, expected a report of match or run", path));
  }
  return wall / std::max(number("/results/frames"), 1.0);
}

/// Files of one scene; `time` is empty where the server asks for none.
struct SceneFiles {
  fs::path map;
  fs::path time;
};

SceneFiles files_of(const SubmissionOptions& options, const std::string& data,
                    const std::string& scene, bool is_sparse) {
  const fs::path folder = options.folder;
  switch (*options.kind) {
    case SubmissionKind::kKitti2015:
      return {folder / "disp_0" / (scene + ".png"), {}};
    case SubmissionKind::kKitti2012:
      return {folder / (scene + ".png"), {}};
    case SubmissionKind::kEth3d:
      return {folder / "low_res_two_view" / (scene + ".pfm"),
              folder / "low_res_two_view" / (scene + ".txt")};
    case SubmissionKind::kMiddlebury:
      break;
  }
  // trainingH, testF and such are folders of the submission as well.
  const std::string set = fs::path(data).lexically_normal().filename().string();
  const bool is_set = set.starts_with("training") || set.starts_with("test");
  const fs::path place = (is_set ? folder / set : folder) / scene;
  return {place / fmt::format("disp0{}{}.pfm", options.method, is_sparse ? "_s" : ""),
          place / fmt::format("time{}.txt", options.method)};
}

}  // namespace

void add_submission_settings(Settings& settings, SubmissionOptions& options) {
  settings.choice<SubmissionKind>("submission", options.kind,
                                  {{"kitti2015", SubmissionKind::kKitti2015},
                                   {"kitti2012", SubmissionKind::kKitti2012},
                                   {"middlebury", SubmissionKind::kMiddlebury},
                                   {"eth3d", SubmissionKind::kEth3d}},
                                  "Write the maps of a folder as this server wants them", "none");
  settings
      .path("output", options.folder, "FOLDER", "Folder of the submission; files are not replaced")
      .short_name = 'o';
  settings.text("method-name", options.method, "NAME", "Part of the file names of middlebury");
  settings.number("time", options.seconds, "SECONDS", "Time per map, for middlebury and eth3d",
                  "none");
  settings.input_path("time-report", options.times, "FILE",
                      "Report of match or run, for the time per map in place of --time");
}

void check_submission(const SubmissionOptions& options, const Settings& settings) {
  if (!options.kind) {
    settings.refuse_idle({"output", "method-name", "time", "time-report"}, "without --submission");
    return;
  }
  if (options.folder.empty()) {
    throw UsageError("--submission needs --output FOLDER");
  }
  require_above_0("time", options.seconds);
  const bool has_time = options.seconds || !options.times.empty();
  if (wants_times(*options.kind) != has_time || (options.seconds && !options.times.empty())) {
    throw UsageError(wants_times(*options.kind)
                         ? "middlebury and eth3d want the time per map, expected one of --time "
                           "SECONDS and --time-report FILE"
                         : "KITTI's servers take no files of times, expected neither --time nor "
                           "--time-report");
  }
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  };
  if (options.method.empty() || !std::ranges::all_of(options.method, is_plain)) {
    throw UsageError(
        fmt::format("--method-name is {}, expected letters, digits, - and _", options.method));
  }
  if (*options.kind != SubmissionKind::kMiddlebury) {
    settings.refuse_idle({"method-name"}, "but for middlebury");
  }
}

std::string write_submission(const SubmissionOptions& options, const std::string& data,
                             const BenchmarkFolder& folder, const ReadMap& read) {
  const double seconds =
      options.times.empty() ? options.seconds.value_or(0) : seconds_of(options.times);
  int maps = 0;
  int sparse_maps = 0;
  for (const BenchmarkScene& scene : folder.scenes) {
    if (scene.map.empty()) {
      continue;
    }
    const DisparityMap map = read(scene.map);
    const bool is_sparse =
        finite_values(map.view()).size() <
        static_cast<std::size_t>(map.width()) * static_cast<std::size_t>(map.height());
    const SceneFiles files = files_of(options, data, scene.name, is_sparse);
    for (const fs::path& file : {files.map, files.time}) {
      if (!file.empty() && fs::exists(file)) {
        throw Error(fmt::format("{}: exists, expected a folder without files of this submission",
                                file.string()));
      }
    }
    fs::create_directories(files.map.parent_path());
    write_disparity(files.map, map.view());
    if (!files.time.empty()) {
      const char* const label = *options.kind == SubmissionKind::kEth3d ? "runtime " : "";
      write_text_file(files.time, fmt::format("{}{:.6g}\n", label, seconds));
    }
    ++maps;
    sparse_maps += is_sparse ? 1 : 0;
  }
  return fmt::format("{} of {} maps, {} with unknown pixels{} -> {}", maps, folder.scenes.size(),
                     sparse_maps, seconds > 0 ? fmt::format(", {:.4g} s each", seconds) : "",
                     options.folder);
}

}  // namespace vantage::apps
