#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/pair_input.h"
#include "apps/pages/view_page.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/run/run_film.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/images/photograph_io.h"
#include "engine/options/settings.h"
#include "engine/options/synthesis_settings.h"

namespace vantage::apps {
namespace {

struct ViewJob {
  PairInput pair;
  ViewPageOptions page;
  CommonOptions common;
  std::string output;
};

std::string as_base64(const std::string& file_name, Image<std::uint8_t> pixels) {
  std::vector<std::uint8_t> bytes;
  encode_photograph(file_name, Photograph{std::move(pixels)}, bytes);
  return encode_base64(bytes);
}

ViewRange to_view_range(const SettingValue& value) {
  return from_parts(value, ':', 2, "A:B with two positions in baselines, such as -0.5:1.5",
                    [](const auto& parts) {
                      return std::optional(ViewRange{to_number(parts[0]), to_number(parts[1])});
                    });
}

void add_range_setting(Settings& settings, const std::string& name, ViewRange& range,
                       const std::string& help) {
  Setting& setting = settings.add(name, "A:B", help);
  setting.set = [&range](const SettingValue& value) { range = to_view_range(value); };
  setting.get = [&range]() -> SettingValue {
    return fmt::format("{}:{}", range.first, range.last);
  };
}

void add_page_settings(Settings& settings, ViewPageOptions& page) {
  settings.start_group("Page");
  add_range_setting(settings, "range", page.range_x,
                    "Range of positions along the baseline: 0 left camera, 1 right camera");
  add_range_setting(settings, "vertical-range", page.range_y,
                    "Range of vertical positions in baselines, positive downwards; 0:0: none");
  settings.choice<PageImages>(
      "images", page.images, {{"png", PageImages::kPng}, {"jpeg", PageImages::kJpeg}},
      "Image format in the page: lossless (png), or smaller; auto: jpeg of a run, else png");
  settings.start_group("View synthesis");
  settings.choice<HoleFilling>(
      "holes", page.synthesis.holes,
      {{"interpolate", HoleFilling::kInterpolate},
       {"mirror", HoleFilling::kMirror},
       {"spread", HoleFilling::kSpread},
       {"none", HoleFilling::kNone}},
      "Filling of areas that no image shows: weighted means of the background (interpolate); "
      "background mirrored along the row (mirror), its border pixel repeated (spread); black "
      "(none)");
  add_combining_settings(settings, page.synthesis);
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Whether LEFT is the folder of a run. Throws UsageError for options of a pair beside it.
bool shows_run(const ViewJob& job, const Settings& settings) {
  std::error_code none;
  if (!job.pair.right.empty() || !std::filesystem::is_directory(job.pair.left, none)) {
    return false;
  }
  PairInput unused;
  Settings of_pairs("view", "");
  add_pair_settings(of_pairs, unused);
  add_match_settings(of_pairs, unused.match);
  const SettingValue options = of_pairs.values();
  for (const auto& [name, value] : options.items()) {
    if (name != "left") {
      settings.refuse_idle({name.c_str()}, "with the folder of a run");
    }
  }
  return true;
}

/// Writes the page and, in a folder beside it, the script of each frame.
int view_run(const ViewJob& job, const Settings& settings, FileChecks& files) {
  namespace fs = std::filesystem;
  const fs::path output = job.output;
  const fs::path folder = output.parent_path() / (output.stem().string() + "-frames");
  files.add_made_folder(folder, "--output");
  RunFilm film(job.pair.left);
  for (const fs::path& file : film.pairs().files()) {
    files.add_input(file);
  }
  CommandWork work(settings, job.common);
  make_folder(folder);
  ViewPage page(job.page, folder.filename().string(), as_base64);
  std::size_t bytes = 0;
  int shown = 0;
  Progress progress("view", "frames",
                    job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
  const FrameRange frames = film.frames();
  for (int frame = frames.first; frame < frames.end; ++frame) {
    if (const std::string problem = film.problem(frame); !problem.empty()) {
      page.add_missing(frame, problem);
      continue;
    }
    const PairWithMaps pair =
        work.report.timed_file_access("read", [&] { return film.read(frame, work.execution); });
    const std::string script = work.report.timed_compute(
        "page", [&] { return page.add_frame(frame, pair, work.execution); });
    work.report.timed_file_access(
        "write", [&] { write_text_file(folder / ViewPage::script_name(frame), script); });
    bytes += script.size();
    progress.update(++shown, frames.count(), 0);
  }
  if (shown == 0) {
    throw Error(fmt::format("{}: none of its frames is there", job.pair.left));
  }
  write_text_file(output, page.html(job.pair.left, film.rate(), ""));
  const int missing = frames.count() - shown;
  return work.finish(
      {{"frames", shown}, {"frames_missing", missing}, {"page_bytes", bytes}},
      fmt::format("{} frames{}, {:.1f} MB -> {} and {}", shown,
                  missing > 0 ? fmt::format(" ({} missing)", missing) : std::string(),
                  static_cast<double>(bytes) / 1e6, job.output, folder.string()));
}

}  // namespace

int command_view(const Arguments& arguments) {
  ViewJob job;
  Settings settings(
      "view",
      "Writes a web page that renders new views of a rectified pair, or of the frames "
      "of a run.");
  settings.start_group("Files");
  add_pair_settings(settings, job.pair);
  Setting& output = settings.path("output", job.output, "FILE.html", "Path to the page");
  output.short_name = 'o';
  output.required = true;
  add_page_settings(settings, job.page);
  add_match_settings(settings, job.pair.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "left-disparity", "right-disparity", "calibration", "output", "range",
       "vertical-range", "images", "holes", "disparities", "preset", "threads", "quiet"},
      {"vantage view left.png right.png -o pair.html", "vantage view results -o film.html",
       "vantage view left.png right.png -o pair.html --images jpeg --range 0:1",
       "vantage view left.jpg right.jpg --calibration rig.yml -o pair.html"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  job.page.validate();
  check_combining(settings, job.page.synthesis);
  job.common.execution.validate();
  const bool is_of_run = shows_run(job, settings);
  if (!is_of_run) {
    check_pair(job.pair, settings);
  }
  FileChecks files(settings);
  files.add_output(job.output, "--output", OutputKind::kPage);
  check_common_files(job.common, files);
  if (is_of_run) {
    return view_run(job, settings, files);
  }

  CommandWork work(settings, job.common, reported_settings(settings, job.pair));
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const PairWithMaps pair = read_pair(job.pair, settings, job.common, execution, report);
  const std::string names = file_name(job.pair.left) + " and " + file_name(job.pair.right);
  const std::string page = report.timed_compute("page", [&] {
    ViewPage made(job.page, "", as_base64);
    const std::string script = made.add_frame(0, pair, execution);
    return made.html(names, {}, script);
  });
  report.timed_file_access("write", [&] { write_text_file(job.output, page); });

  return work.finish(
      {{"page_bytes", page.size()}},
      fmt::format("{}x{} pixels, {:.1f} MB -> {}", pair.left.width(), pair.left.height(),
                  static_cast<double>(page.size()) / 1e6, job.output));
}

}  // namespace vantage::apps
