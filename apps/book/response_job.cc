#include "apps/book/response_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "apps/commands/commands.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/npy.h"
#include "engine/options/match_settings.h"

namespace vantage::apps {
namespace {

constexpr int kParts = static_cast<int>(kImagePartNames.size());

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

void write_sums(const std::string& path, const CumulativeResponse& response) {
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

int run_response(const ResponseJob& job, const Settings& settings) {
  check(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  const auto read = [&](const std::string& path) {
    return report.timed_file_access("read", [&] { return read_photograph(path); });
  };
  const Photograph left = read(job.left);
  const Photograph right = read(job.right);
  const CumulativeResponseOptions options = options_of(job, left.width());
  const CumulativeResponse response = report.timed_compute(
      "response", [&] { return cumulative_response(left, right, options, work.execution); });
  report.timed_file_access("write", [&] { write_sums(job.output, response); });
  return work.finish(
      {{"dominant", print_dominant(response)}},
      fmt::format("{}x{} pixels, displacements {} x {} -> {}", left.width(), left.height(),
                  to_text(options.displacements_x), to_text(options.displacements_y), job.output));
}

}  // namespace vantage::apps
