#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "perf/quality/markdown.h"
#include "perf/quality/results.h"
#include "perf/quality/scene_groups.h"

namespace vantage::perf {
namespace {

template <typename OfScene>
SubPixelFigures mean(const std::vector<std::size_t>& scenes, const OfScene& of_scene) {
  SubPixelFigures sum;
  const auto n = static_cast<double>(scenes.size());
  for (const std::size_t scene : scenes) {
    const SubPixelFigures& one = of_scene(scene);
    for (std::size_t bin = 0; bin < kFractionBins; ++bin) {
      sum.fraction_percent[bin] += one.fraction_percent[bin] / n;
    }
    sum.mean_absolute_error_px += one.mean_absolute_error_px / n;
    sum.rms_error_px += one.rms_error_px / n;
  }
  return sum;
}

void print_row(const std::string& name, const SubPixelFigures& figures) {
  fmt::print("| {} |", name);
  for (const double percent : figures.fraction_percent) {
    fmt::print(" {} |", cell(percent, 1));
  }
  fmt::print(" {} | {} | {} |\n", cell(fullest_over_emptiest(figures), 2),
             cell(figures.mean_absolute_error_px, 3), cell(figures.rms_error_px, 3));
}

void print_group(const Results& results, const SceneGroup& group) {
  std::vector<std::size_t> scenes = group.scenes;
  std::erase_if(scenes, [&](std::size_t scene) { return !results.scenes[scene]->is_fractional; });
  if (scenes.empty()) {
    return;
  }
  fmt::print("\nFractions of disparities within 1 px of the truth, {}, {} scenes:\n\n", group.name,
             scenes.size());
  std::vector<std::string> titles;
  for (int bin = 0; bin < kFractionBins; ++bin) {
    titles.push_back(fmt::format("{:.3f}", static_cast<double>(bin) / kFractionBins));
  }
  titles.insert(titles.end(), {"fullest ÷ emptiest", "mean error, px", "RMS, px"});
  print_header(titles);
  print_row("truth", mean(scenes, [&](std::size_t scene) -> const SubPixelFigures& {
              return results.truth_sub_pixel[scene];
            }));
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    print_row(results.contenders[i].name,
              mean(scenes, [&](std::size_t scene) -> const SubPixelFigures& {
                return results.outcomes[i][scene].sub_pixel;
              }));
  }
}

}  // namespace

void print_sub_pixel_tables(const Results& results) {
  for (const SceneGroup& group : scene_groups(results.scenes)) {
    print_group(results, group);
  }
}

}  // namespace vantage::perf
