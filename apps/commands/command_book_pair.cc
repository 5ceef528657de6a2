#include <fmt/format.h>

#include "apps/commands/commands.h"
#include "apps/match/generated_files.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/generation/book_pairs.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

struct BookPairJob {
  BookPairOptions pair;
  CommonOptions common;
  std::string output;
  bool overwrite = false;
};

void add_pair_settings(Settings& settings, BookPairJob& job) {
  settings.start_group("Files");
  Setting& output = settings.path("output", job.output, "DIR", "Output folder");
  output.short_name = 'o';
  output.required = true;
  add_overwrite_setting(settings, job.overwrite);

  settings.start_group("Pair");
  BookPairOptions& pair = job.pair;
  std::string names;
  for (const std::string_view name : kBookPairNames) {
    names += (names.empty() ? "" : "|") + std::string(name);
  }
  Setting& pattern = settings.add("pattern", names, "Texture and shapes");
  pattern.kind = ValueKind::kWord;
  pattern.words = {kBookPairNames.begin(), kBookPairNames.end()};
  pattern.set = [&pair, names](const SettingValue& value) {
    for (const std::string_view name : kBookPairNames) {
      if (value == name) {
        const BookPairOptions named = book_pair_options(name);
        pair.pattern = named.pattern;
        pair.shape = named.shape;
        return;
      }
    }
    reject_value(value, "one of " + names);
  };
  pattern.get = [&pair]() -> SettingValue {
    for (const std::string_view name : kBookPairNames) {
      const BookPairOptions named = book_pair_options(name);
      if (named.pattern == pair.pattern && named.shape == pair.shape) {
        return name;
      }
    }
    return nullptr;
  };
  settings.integer("width", pair.width_px, "PX", "Width of the images");
  settings.integer("height", pair.height_px, "PX", "Height of the images");
  settings.integer("background-disparity", pair.background_disparity_px, "PX",
                   "Disparity of the background");
  settings.integer("front-disparity", pair.front_disparity_px, "PX",
                   "Disparity of the square or rectangle; auto: 6 and 7");
  settings.integer("narrow-disparity", pair.narrow_disparity_px, "PX",
                   "Disparity of the narrow bar; auto: 16");
  settings.number(
      "noise", pair.noise_sigma, "SIGMA",
      "Standard deviation of the noise in both images, in grey levels; writes float images");
  settings.flag("float", pair.float_pixels, "Write float images (PFM) even without noise");
  settings.choice<Side>("reference", pair.reference,
                        {{"left", Side::kLeft}, {"right", Side::kRight}},
                        "Image in which the shapes are placed");
  add_seed_setting(settings, pair.seed);
}

}  // namespace

int command_book_pair(const Arguments& arguments) {
  BookPairJob job;
  Settings settings("book pair",
                    "Generates a synthetic pair of the book with its true disparities.");
  add_pair_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  settings.set_short_help(
      {"output", "pattern", "width", "height", "background-disparity", "front-disparity",
       "narrow-disparity", "noise", "float", "reference", "seed"},
      {"vantage book pair -o pair", "vantage book pair --width 512 --height 512 -o pair",
       "vantage book pair --noise 5 --seed 2 -o pair"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  job.pair.validate();
  if (job.pair.shape == BookShape::kSquare) {
    settings.refuse_idle({"narrow-disparity"}, "without bars (--pattern rds-bars or real-bars)");
  }
  job.common.execution.validate();
  FileChecks checks(settings);
  GeneratedFiles::check(
      job.output, false,
      {"left", "right", "left-disparity", "right-disparity", "left-occluded", "right-occluded"},
      checks);
  checks.require_nothing_made_unless(job.overwrite);
  check_common_files(job.common, checks);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;

  const BookPair pair = report.timed_compute("generate", [&] { return make_book_pair(job.pair); });
  report.timed_file_access("write", [&] {
    const GeneratedFiles files(job.output, false);
    files.write("left", 0, pair.left);
    files.write("right", 0, pair.right);
    files.write("left-disparity", 0, pair.left_disparity);
    files.write("right-disparity", 0, pair.right_disparity);
    files.write("left-occluded", 0, pair.left_occluded);
    files.write("right-occluded", 0, pair.right_occluded);
  });

  return work.finish(
      {{"disparities", fmt::format("{}:{}", pair.search.min, pair.search.max)}},
      fmt::format("{}x{} pixels, search with --disparities={}:{} -> {}", pair.left.width(),
                  pair.left.height(), pair.search.min, pair.search.max, job.output));
}

}  // namespace vantage::apps
