#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/automatic_disparities.h"
#include "apps/commands.h"
#include "apps/frame_rate_setting.h"
#include "apps/interrupt.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "apps/view_output.h"
#include "engine/error.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage::apps {
namespace {

/// Views at equal steps from one position to another, both included.
struct Sweep {
  double first_x = 0;
  double last_x = 1;
  int views = 0;
};

struct SynthJob {
  MatchOptions match;
  SynthesisOptions synthesis;
  CommonOptions common;
  std::string left;
  std::string right;
  std::string output;
  std::vector<double> views_x;
  std::optional<Sweep> sweep;
  std::string left_disparity;
  std::string right_disparity;
  std::optional<double> disparity_scale;
  std::string hole_mask;
  FrameRate frame_rate;

  [[nodiscard]] bool has_maps() const { return !left_disparity.empty(); }
};

constexpr int kMaxSweepViews = 10000;

Sweep to_sweep(const SettingValue& value) {
  const auto parts = split(value.is_string() ? value.get<std::string>() : "", ':');
  try {
    if (parts.size() == 3) {
      const Sweep sweep{to_number(parts[0]), to_number(parts[1]), to_integer(parts[2])};
      if (sweep.views >= 2 && sweep.views <= kMaxSweepViews) {
        return sweep;
      }
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value,
               fmt::format("FIRST:LAST:VIEWS with 2 to {} views, such as 0:1:25", kMaxSweepViews));
}

void add_view_settings(Settings& settings, SynthJob& job) {
  settings.begin_group("Views");
  add_view_setting(settings, job.views_x);
  Setting& sweep = settings.add("sweep", "A:B:N", "N views at equal steps from XS = A to XS = B");
  sweep.set = [&job](const SettingValue& value) { job.sweep = to_sweep(value); };
  sweep.get = [&job]() -> SettingValue {
    return job.sweep ? SettingValue(fmt::format("{}:{}:{}", job.sweep->first_x, job.sweep->last_x,
                                                job.sweep->views))
                     : SettingValue();
  };
  add_frame_rate_setting(settings, "fps", job.frame_rate, "Views per second of a video");
}

void add_file_settings(Settings& settings, SynthJob& job) {
  settings.begin_group("Files");
  settings.positional("left", job.left, "Left image").required = true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  Setting& output =
      settings.text("output", job.output, "FILE",
                    "Image to write; for several views a pattern (views/%03d.png) or an .mp4");
  output.short_name = 'o';
  output.required = true;
  settings.text("left-disparity", job.left_disparity, "FILE",
                "Disparity map of the left image; without maps the pair is matched");
  settings.text("right-disparity", job.right_disparity, "FILE", "Disparity map of the right image");
  settings.number("disparity-scale", job.disparity_scale, "S",
                  "Divides the values of integer disparity files; auto: 256 for 16-bit PNG");
  settings.text("hole-mask", job.hole_mask, "MASK.png",
                "Write a mask of the pixels that no image shows; a pattern for several views");
}

/// Matching options that the command line gives beside maps would have no effect.
void refuse_idle_match_options(const Settings& settings) {
  Settings matching("match", "");
  MatchOptions unused;
  add_match_settings(matching, unused);
  const SettingValue options = matching.values();
  for (const auto& [name, value] : options.items()) {
    if (settings.given_on_command_line(name)) {
      throw UsageError(
          fmt::format("--{} has no effect with --left-disparity and --right-disparity", name));
    }
  }
}

std::vector<double> views_of(const SynthJob& job) {
  if (job.sweep.has_value() == !job.views_x.empty()) {
    throw UsageError(job.sweep ? "--view and --sweep are both given, expected one of them"
                               : "no view is given, expected --view XS or --sweep A:B:N");
  }
  std::vector<double> views = job.views_x;
  if (job.sweep) {
    for (int i = 0; i < job.sweep->views; ++i) {
      const double t = static_cast<double>(i) / (job.sweep->views - 1);
      views.push_back(job.sweep->first_x + t * (job.sweep->last_x - job.sweep->first_x));
    }
  }
  for (const double view_x : views) {
    if (std::abs(view_x) > 16) {
      throw UsageError(fmt::format("view is {}, expected a number within ±16", view_x));
    }
  }
  return views;
}

void check(const SynthJob& job, const Settings& settings, const ViewOutput& output,
           const std::optional<ViewOutput>& hole_mask) {
  job.synthesis.validate();
  job.common.execution.validate();
  if (job.left_disparity.empty() != job.right_disparity.empty()) {
    throw UsageError(
        "one of --left-disparity and --right-disparity is missing, expected both or "
        "none");
  }
  if (job.disparity_scale && !(*job.disparity_scale > 0)) {
    throw UsageError(
        fmt::format("--disparity-scale is {}, expected a number above 0", *job.disparity_scale));
  }
  if (job.has_maps()) {
    refuse_idle_match_options(settings);
  } else {
    job.match.validate();
    if (job.match.disparities_y) {
      throw UsageError("--disparities-y has no use here: views come from rectified pairs");
    }
    if (job.disparity_scale) {
      throw UsageError("--disparity-scale has no effect without --left-disparity");
    }
  }
  FileChecks files;
  for (const std::string& input : {job.left, job.right, job.left_disparity, job.right_disparity}) {
    files.add_input(input);
  }
  output.check(files, "--output");
  if (hole_mask) {
    hole_mask->check(files, "--hole-mask");
  }
  files.add_output(job.common.report, "--report", OutputKind::kText);
}

DisparityMaps maps_of(const SynthJob& job, const Photograph& left, const Photograph& right,
                      Execution& execution, RunReport& report) {
  DisparityMaps maps;
  if (job.has_maps()) {
    report.timed_file_access("read", [&] {
      const double scale = job.disparity_scale.value_or(0);
      maps.left = read_disparity(job.left_disparity, scale);
      maps.right = read_disparity(job.right_disparity, scale);
    });
    return maps;
  }
  const StereoMatcher matcher(job.match, execution);
  report.add_match(report.timed_compute([&] {
    MatchReport result;
    matcher.match(left, right, {}, maps, &result);
    return result;
  }));
  return maps;
}

SettingValue describe(double view_x, const SynthesizedView& view) {
  SettingValue fits = SettingValue::array();
  const int channels = std::min(view.image.channels(), static_cast<int>(view.intensity.size()));
  for (int channel = 0; channel < channels; ++channel) {
    const IntensityFit& fit = view.intensity[static_cast<std::size_t>(channel)];
    fits.push_back({{"offset", fit.offset}, {"gain", fit.gain}});
  }
  return {{"view_x", view_x}, {"hole_fraction", view.hole_fraction}, {"intensity", fits}};
}

}  // namespace

int command_synth(const Arguments& arguments) {
  SynthJob job;
  Settings settings("synth", "Renders new views on the baseline of a rectified stereo pair.");
  add_file_settings(settings, job);
  add_view_settings(settings, job);
  add_synthesis_settings(settings, job.synthesis);
  add_match_settings(settings, job.match);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const std::vector<double> views_x = views_of(job);
  const int views = static_cast<int>(views_x.size());
  ViewOutput output(job.output, views);
  std::optional<ViewOutput> hole_mask;
  if (!job.hole_mask.empty()) {
    hole_mask.emplace(job.hole_mask, views);
  }
  check(job, settings, output, hole_mask);
  RunReport report(settings.command(),
                   job.has_maps() ? settings.values() : reported_settings(settings, job.match));
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  const ViewSynthesizer synthesizer(job.synthesis, execution);

  const auto read = [&](const std::string& path) {
    return report.timed_file_access("read", [&] { return read_photograph(path); });
  };
  const Photograph left = read(job.left);
  const Photograph right = read(job.right);
  if (!job.has_maps()) {
    choose_disparities(settings, job.common, left, right, job.match, execution, report);
  }
  const DisparityMaps maps = maps_of(job, left, right, execution, report);

  const std::atomic<bool>& interrupted = interrupt_flag();
  SettingValue results = SettingValue::array();
  SynthesizedView view;
  {
    Progress progress("synth", "views",
                      job.common.quiet || views == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
    for (int index = 0; index < views && !interrupted.load(); ++index) {
      const double view_x = views_x[static_cast<std::size_t>(index)];
      report.timed_compute("views", [&] {
        synthesizer.synthesize(left, right, maps.left.view(), maps.right.view(), view_x, view);
      });
      report.timed_file_access("write", [&] {
        output.write(index, view.image, job.frame_rate);
        if (hole_mask) {
          hole_mask->write(index, {view.holes.copy()}, job.frame_rate);
        }
      });
      results.push_back(describe(view_x, view));
      progress.update(index + 1, views, 0);
    }
  }
  if (interrupted.load()) {
    if (!job.common.quiet) {
      fmt::print(stderr, "synth: interrupted after {} of {} views\n", results.size(), views);
    }
    return kExitInterrupted;
  }
  report.timed_file_access("write", [&] {
    output.finish();
    if (hole_mask) {
      hole_mask->finish();
    }
  });

  report.set_results({{"views", results}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print(stderr, "synth: {}x{} pixels, {} view{} -> {}\n", left.width(), left.height(), views,
               views == 1 ? "" : "s", job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
