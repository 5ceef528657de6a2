#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "apps/book/response_drawings.h"
#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/evaluation/cumulative_response.h"
#include "engine/evaluation/rms_differences.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/npy.h"
#include "engine/options/match_settings.h"
#include "engine/options/parameter_settings.h"
#include "engine/options/settings.h"
#include "engine/plot/drawing.h"

namespace vantage::apps {
namespace {

struct ResponseJob {
  MethodOverrides parameters;
  std::optional<DisparityRange> displacements_x;  ///< default: −16 to a quarter of the width
  DisparityRange displacements_y = {0, 0};
  CommonOptions common;
  std::string left;
  std::string right;
  std::string output;
  std::string rms;
  std::string evidence_pictures;
  std::string plot;
};

constexpr const char* kAutomatic = "auto";
constexpr int kParts = static_cast<int>(kImagePartNames.size());

void add_response_settings(Settings& settings, ResponseJob& job) {
  settings.start_group("Files");
  settings.positional("left", job.left, "Left image").required = true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  Setting& output =
      settings.path("output", job.output, "FILE",
                    "Path to the sums: .csv with one row per displacement, or .npy of shape (5, y, "
                    "x): whole image, top left, top right, bottom left and bottom right quadrant");
  output.short_name = 'o';
  output.required = true;
  settings.path("rms", job.rms, "FILE",
                "Also write the root-mean-square difference of grey levels for each displacement, "
                "over the pixels that have a partner: .csv, or .npy of shape (y, x)");
  settings.path("evidence-pictures", job.evidence_pictures, "FILE",
                "Draw the evidence at each pixel for the displacement with the largest sum of the "
                "image and of each quadrant: light is for, dark against a match: .svg .png ...");
  settings.path("plot", job.plot, "FILE",
                "Plot the sums per pixel, with --rms beside the negated differences, as curves "
                "over one range or heat maps over two: .svg .png .jpg ...");

  settings.start_group("Displacements");
  Setting& x = settings.add("displacements-x", "MIN:MAX",
                            "Range of x_left - x_right in pixels, both ends included; auto: -16 to "
                            "a quarter of the width");
  x.set = [&job](const SettingValue& value) {
    job.displacements_x = value == kAutomatic
                              ? std::nullopt
                              : std::optional(to_disparity_range(value,
                                                                 "MIN:MAX in whole pixels, such as "
                                                                 "-16:63, or auto"));
  };
  x.get = [&job]() -> SettingValue {
    return job.displacements_x ? to_text(*job.displacements_x) : kAutomatic;
  };
  Setting& y = settings.add("displacements-y", "MIN:MAX",
                            "Range of y_left - y_right in pixels, both ends included");
  y.set = [&job](const SettingValue& value) {
    job.displacements_y = to_disparity_range(value, "MIN:MAX in whole pixels, such as -4:4");
  };
  y.get = [&job] { return to_text(job.displacements_y); };

  settings.start_group("Evidence");
  add_gradient_settings(settings, job.parameters);
}

CumulativeResponseOptions options_of(const ResponseJob& job, int width) {
  constexpr int kMin_px = -16;
  return {.displacements_x =
              job.displacements_x.value_or(DisparityRange{kMin_px, std::max(0, width / 4)}),
          .displacements_y = job.displacements_y,
          .parameters = resolve(MatchMethod::kGradient, job.parameters)};
}

void check(const ResponseJob& job, const Settings& settings) {
  options_of(job, 0).validate();
  if (job.parameters.gradient_components == GradientComponents::kX) {
    settings.refuse_idle({"norm"}, "with --gradient-components x");
  }
  job.common.execution.validate();
  FileChecks files(settings);
  files.add_output(job.output, "--output", OutputKind::kTable);
  files.add_output(job.rms, "--rms", OutputKind::kTable);
  files.add_output(job.evidence_pictures, "--evidence-pictures", OutputKind::kPlot);
  files.add_output(job.plot, "--plot", OutputKind::kPlot);
  check_common_files(job.common, files);
}

std::string csv(const CumulativeResponse& response) {
  std::string text = "dx_px,dy_px";
  for (const std::string_view name : kImagePartNames) {
    text += fmt::format(",{}", name);
  }
  text += '\n';
  std::size_t index = 0;
  for (int dy = response.displacements_y.min; dy <= response.displacements_y.max; ++dy) {
    for (int dx = response.displacements_x.min; dx <= response.displacements_x.max; ++dx) {
      text += fmt::format("{},{}", dx, dy);
      for (const std::vector<double>& surface : response.surfaces) {
        text += fmt::format(",{}", surface[index]);
      }
      text += '\n';
      ++index;
    }
  }
  return text;
}

void write_data(const std::string& path, const CumulativeResponse& response) {
  if (has_extension(path, {".csv"})) {
    write_text_file(path, csv(response));
    return;
  }
  std::vector<double> values;
  for (const std::vector<double>& surface : response.surfaces) {
    values.insert(values.end(), surface.begin(), surface.end());
  }
  const int shape[] = {kParts, response.displacements_y.count(), response.displacements_x.count()};
  write_binary_file(path, encode_npy(values, shape));
}

void write_rms(const std::string& path, const CumulativeResponse& response,
               const std::vector<double>& rms) {
  const int columns = response.displacements_x.count();
  if (!has_extension(path, {".csv"})) {
    const int shape[] = {response.displacements_y.count(), columns};
    write_binary_file(path, encode_npy(rms, shape));
    return;
  }
  std::string text = "dx_px,dy_px,rms_grey_levels\n";
  for (std::size_t i = 0; i < rms.size(); ++i) {
    text += fmt::format("{},{},{}\n", response.displacements_x.min + static_cast<int>(i) % columns,
                        response.displacements_y.min + static_cast<int>(i) / columns, rms[i]);
  }
  write_text_file(path, text);
}

/// Prints the table to stdout and returns it for the report.
SettingValue print_dominant(const CumulativeResponse& response) {
  SettingValue results = SettingValue::object();
  fmt::print("{:<14}{:>6}{:>6}{:>16}{:>12}\n", "part", "dx", "dy", "response", "per pixel");
  for (int part = 0; part < kParts; ++part) {
    const auto image_part = static_cast<ImagePart>(part);
    const std::string name(kImagePartNames[static_cast<std::size_t>(part)]);
    if (const auto dominant = response.dominant(image_part)) {
      const double sum = response.at(image_part, *dominant);
      fmt::print("{:<14}{:>6}{:>6}{:>16.1f}{:>12.4f}\n", name, dominant->x_px, dominant->y_px, sum,
                 sum / response.pixels(image_part));
      results[name] = {{"dx_px", dominant->x_px}, {"dy_px", dominant->y_px}, {"response", sum}};
    } else {
      fmt::print("{:<14}  none: no evidence for any displacement\n", name);
      results[name] = nullptr;
    }
  }
  return results;
}

}  // namespace

int command_book_response(const Arguments& arguments) {
  ResponseJob job;
  Settings settings("book response",
                    "Sums the gradient evidence of a pair for a range of displacements, over the "
                    "image and its quadrants, and prints the maxima.");
  add_response_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "output", "plot", "displacements-x", "displacements-y", "threads", "quiet"},
      {"vantage book response left.png right.png -o response.csv --plot response.svg",
       "vantage book response left.png right.png -o response.csv --displacements-x 0:63",
       "vantage book response left.png right.png -o response.npy --displacements-y -4:4"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;

  const auto read = [&](const std::string& path) {
    return report.timed_file_access("read", [&] { return read_photograph(path); });
  };
  const Photograph left = read(job.left);
  const Photograph right = read(job.right);
  const CumulativeResponseOptions options = options_of(job, left.width());
  const CumulativeResponse response = report.timed_compute(
      "response", [&] { return cumulative_response(left, right, options, execution); });
  std::vector<double> rms;
  if (!job.rms.empty()) {
    rms = report.timed_compute("rms", [&] {
      return rms_differences(left, right, options.displacements_x, options.displacements_y,
                             execution);
    });
  }
  std::optional<Drawing> pictures;
  if (!job.evidence_pictures.empty()) {
    pictures = report.timed_compute("evidence pictures", [&] {
      return draw_evidence(response, left, right, options.parameters, execution);
    });
  }
  report.timed_file_access("write", [&] {
    write_data(job.output, response);
    if (!rms.empty()) {
      write_rms(job.rms, response, rms);
    }
    if (pictures) {
      write_drawing(job.evidence_pictures, *pictures);
    }
    if (!job.plot.empty()) {
      write_drawing(job.plot, draw_response(response, rms));
    }
  });

  SettingValue results = {{"dominant", print_dominant(response)}};
  if (const auto smallest = smallest_rms(response, rms)) {
    results["smallest_rms"] = {{"dx_px", smallest->displacement.x_px},
                               {"dy_px", smallest->displacement.y_px},
                               {"rms_grey_levels", smallest->rms}};
    fmt::print("{:<14}{:>6}{:>6}{:>16.4f} grey levels\n", "smallest RMS",
               smallest->displacement.x_px, smallest->displacement.y_px, smallest->rms);
  }
  report.set_results(results);
  report.write(job.common.report);
  if (!job.common.quiet) {
    tell("book response: {}x{} pixels, displacements {} x {} -> {}\n", left.width(), left.height(),
         to_text(options.displacements_x), to_text(options.displacements_y), job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
