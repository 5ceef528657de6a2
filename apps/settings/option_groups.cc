#include "apps/settings/option_groups.h"

#include <fmt/format.h>

#include "engine/error.h"

namespace vantage::apps {
void add_common_settings(Settings& settings, CommonOptions& options, Work work) {
  using scheduler::ExecutorKind;
  using scheduler::ThreadBinding;
  settings.start_group("Execution (never changes a result)", false);
  settings.integer("threads", options.execution.threads, "N",
                   "Number of threads, 1 to 1024; auto: all that this process may use");
  settings.choice<ExecutorKind>("executor", options.execution.executor,
                                {{"tbb", ExecutorKind::kTbb},
                                 {"openmp", ExecutorKind::kOpenMp},
                                 {"serial", ExecutorKind::kSerial}},
                                "Threading library");
  settings.choice<ThreadBinding>("bind", options.execution.binding,
                                 {{"none", ThreadBinding::kNone},
                                  {"node", ThreadBinding::kNodes},
                                  {"core", ThreadBinding::kCores}},
                                 "Bind each thread to one NUMA node or to one core; auto: to nodes "
                                 "if one node has too few cores for all threads");
  if (work == Work::kWithMatching) {
    settings.integer("strip-width", options.execution.strip_width_px, "PX",
                     "Columns per strip; auto: from the cache sizes");
    settings.integer("band-height", options.execution.band_height_px, "PX",
                     "Rows per band; auto: from the cache sizes");
    settings.integer("iterations-per-pass", options.execution.iterations_per_pass, "K",
                     "Iterations per pass over memory; auto: from the cache sizes");
  }
  settings.text("isa", options.isa, "NAME",
                "Instruction set of the kernels: best, or a name from 'vantage info'; with "
                "--prior-smoothing sum it changes last bits");
  settings.start_group("Messages", false);
  settings.path("report", options.report, "FILE", "Write a JSON report");
  settings.path("trace", options.trace, "FILE",
                "Write a trace of all threads as Chrome trace events, for Perfetto");
  settings.flag("quiet", options.quiet, "Print errors only");
}

void check_common_files(const CommonOptions& options, FileChecks& files) {
  files.add_output(options.report, "--report", OutputKind::kText);
  files.add_output(options.trace, "--trace", OutputKind::kText);
}

void add_synthesis_settings(Settings& settings, SynthesisOptions& options) {
  settings.start_group("View synthesis");
  settings.choice<WarpColour>(
      "warp", options.warp, {{"one-pass", WarpColour::kOnePass}, {"forward", WarpColour::kForward}},
      "Colours of views. one-pass: one bicubic interpolation of the photograph; forward: whole "
      "pixels are moved, as in Scharstein's book (with cameras: between rectification and its "
      "inverse)");
  add_holes_setting(settings, options.holes);
  add_soft_edges_setting(settings, options.soft_edges);
  add_combining_settings(settings, options);
}

void add_soft_edges_setting(Settings& settings, bool& soft_edges) {
  settings.choice<bool>(
      "soft-edges", soft_edges, {{"on", true}, {"off", false}},
      "Blend the edges of objects as in a photograph, without remains of their old background");
}

void add_holes_setting(Settings& settings, HoleFilling& holes) {
  settings.choice<HoleFilling>(
      "holes", holes,
      {{"mirror", HoleFilling::kMirror},
       {"spread", HoleFilling::kSpread},
       {"inpaint", HoleFilling::kInpaint},
       {"texture", HoleFilling::kTexture},
       {"none", HoleFilling::kNone}},
      "Filling of areas that no image shows: background mirrored along the row (mirror), its "
      "border pixel repeated (spread), continued from all sides (inpaint) or copied in patches "
      "(texture), or black (none)");
}

void add_combining_settings(Settings& settings, SynthesisOptions& options) {
  settings.number("gamma", options.gamma, "G",
                  "Brightness of views, 0 to 1: 1 as the left image, 0 as the right image; alpha: "
                  "by the position of the view",
                  "alpha");
  add_surface_settings(settings, options);
}

void check_combining(const Settings& settings, const SynthesisOptions& options) {
  if (!options.match_intensities) {
    settings.refuse_idle({"gamma"}, "with --no-intensity-matching");
  }
}

void add_surface_settings(Settings& settings, SynthesisOptions& options) {
  settings.number(
      "gradient-limit", options.disparity_gradient_limit_px, "PX",
      "Neighbouring pixels belong to one surface if their disparities differ by at most PX");
  Setting& no_matching =
      settings.add("no-intensity-matching", "", "Do not match the brightness of the images");
  no_matching.flag = true;
  no_matching.set = [&options](const SettingValue& value) {
    options.match_intensities = !to_truth(value);
  };
  no_matching.get = [&options] { return !options.match_intensities; };
}

std::uint64_t to_seed(const SettingValue& value) {
  const int number = to_integer(value);
  if (number < 0) {
    reject_value(value, "a whole number of at least 0");
  }
  return static_cast<std::uint64_t>(number);
}

void add_seed_setting(Settings& settings, std::uint64_t& seed) {
  Setting& setting = settings.add("seed", "N", "Random seed; the same seed gives the same images");
  setting.set = [&seed](const SettingValue& value) { seed = to_seed(value); };
  setting.get = [&seed] { return seed; };
}

}  // namespace vantage::apps
