#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/cumulative_response.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/figures/figure_families.h"
#include "engine/figures/figure_images.h"
#include "engine/figures/pair_runs.h"
#include "engine/figures/scene_maps.h"
#include "engine/figures/several_images.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/seconds_since.h"
#include "engine/simd.h"
#include "engine/synthesis/view_synthesizer.h"
#include "scheduler/machine.h"

namespace vantage {
namespace {

/// Shortest time of some runs: other programs can only make one longer.
template <typename Work>
double seconds_of(const Work& work, int runs = 3) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, seconds_since(start));
  }
  return best;
}

std::string machine_text(const FigureRun& run) {
  return fmt::format("{}, {} threads, {}", scheduler::detect_machine().processor,
                     run.execution.executor().thread_count(), instruction_set_in_use());
}

std::string time_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.3g} ms", seconds * 1000) : fmt::format("{:.3g} s", seconds);
}

std::string size_text(const FigureImages& images) {
  return images.is_transposed ? fmt::format("{}x{}", images.left.height(), images.left.width())
                              : fmt::format("{}x{}", images.left.width(), images.left.height());
}

FigureContent table_of_times(std::vector<BookComparison> comparisons, std::string images) {
  FigureContent content;
  content.comparisons = std::move(comparisons);
  content.images = std::move(images);
  return content;
}

FigureContent make_view_times(const FigureRun& run) {
  const auto images = images_of(BookImages::kKids, run);
  std::vector<BookComparison> comparisons = {
      {"machine", "SPARCstation 5", machine_text(run)},
      {"image size, disparities", "350x236, 45",
       fmt::format("{}, {}", size_text(*images), images->disparities.count())}};
  for (const std::string& method : run.settings.methods) {
    const MatchOptions options = scene_options(
        run.settings, method, run.settings.iterations.front(), images->disparities, true);
    const StereoMatcher matcher(options, run.execution);
    DisparityMaps maps;
    const double match_seconds =
        seconds_of([&] { matcher.match(images->left, images->right, {}, maps); });
    const ViewSynthesizer synthesizer({.warp = WarpColour::kForward, .soft_edges = false},
                                      run.execution);
    SynthesizedView view;
    const double view_seconds = seconds_of([&] {
      synthesizer.synthesize(images->left, images->right, maps.left.disparity_px.view(),
                             maps.right.disparity_px.view(), 0.5, view);
    });
    comparisons.push_back({method + ": both disparity maps", "38 s", time_text(match_seconds)});
    comparisons.push_back({method + ": a new view", "1.1 s", time_text(view_seconds)});
  }
  return table_of_times(std::move(comparisons), images->description);
}

/// Largest |L2 − L_oct| / L2 over directions, percent.
double octagon_error_percent() {
  // (5.15) to (5.17).
  const double scale = 2 / (1 + std::sqrt(4 - std::sqrt(8.0)));
  const double of_l1 = (std::numbers::sqrt2 - 1) * scale;
  const double of_max = (2 - std::numbers::sqrt2) * scale;
  constexpr int kDirections = 36000;
  double largest = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const double x = std::abs(std::cos(angle));
    const double y = std::abs(std::sin(angle));
    largest = std::max(largest, std::abs(1 - of_l1 * (x + y) - of_max * std::max(x, y)));
  }
  return 100 * largest;
}

FigureContent make_evidence_times(const FigureRun& run) {
  constexpr DisparityRange kDisplacements = {-15, 16};
  const auto images = images_of(BookImages::kStreet, run);
  CumulativeResponseOptions options;
  options.displacements_x = kDisplacements;
  constexpr int kComparedRuns = 15;  // the norms differ by less than the noise of a few runs
  const auto seconds_with = [&](GradientNorm norm) {
    FigureSettings settings = run.settings;
    settings.parameters.norm = norm;
    options.parameters =
        compared_options(compared_method("gradient"), BookPattern::kGrass, 0, settings.parameters)
            .resolved();
    return seconds_of(
               [&] { cumulative_response(images->left, images->right, options, run.execution); },
               kComparedRuns) /
           kDisplacements.count();
  };
  const double l2 = seconds_with(GradientNorm::kL2);
  const double octagon = seconds_with(GradientNorm::kOctagon);
  const auto map_with = [&](GradientNorm norm) {
    FigureSettings settings = run.settings;
    settings.parameters.norm = norm;
    return scene_maps(*images, scene_options(settings, "gradient", 0, images->disparities, false),
                      run.execution);
  };
  const DisparityMaps with_l2 = map_with(GradientNorm::kL2);
  const DisparityMaps with_octagon = map_with(GradientNorm::kOctagon);
  const double changed_percent =
      percent_where(with_l2.left.disparity_px, [&](int x, int y, float disparity) {
        return disparity != with_octagon.left.disparity_px.at(x, y);
      });
  const double pixels = static_cast<double>(images->left.width()) * images->left.height();
  return table_of_times(
      {{"machine", "SPARCstation 5", machine_text(run)},
       {"evidence and its sum for one displacement, gradients included", "1.2 s for 512x512",
        fmt::format("{} for {}; {} for 512x512 at the same rate", time_text(l2), size_text(*images),
                    time_text(l2 * 512 * 512 / pixels))},
       {"octagon norm instead of the square root", "30 % faster",
        octagon <= l2 ? fmt::format("{:.0f} % faster", 100 * (l2 / octagon - 1))
                      : fmt::format("{:.0f} % slower", 100 * (octagon / l2 - 1))},
       {"largest relative error of the octagon norm", "below 4 %",
        fmt::format("{:.2f} %", octagon_error_percent())},
       {"matches with the octagon norm", "usually not affected",
        fmt::format("{:.2f} % of the winners change", changed_percent)}},
      images->description);
}

FigureContent make_bayes_times(const FigureRun& run) {
  struct BookTime {
    BookImages images;
    const char* name;
    const char* size;
    const char* seconds;
  };
  std::vector<BookComparison> comparisons = {{"machine", "DEC Alpha", machine_text(run)}};
  std::string images_text;
  FigureSettings settings = run.settings;
  for (const auto& [which, name, size, seconds] :
       {BookTime{BookImages::kTree, "tree", "256x233, 16", "220 s"},
        BookTime{BookImages::kTown, "town", "240x256, 9", "119 s"}}) {
    const FigureRun scaled{settings, run.execution, run.stop, run.given};
    settings.size_px = std::max(
        16, *run.settings.size_px * default_width(which) / default_width(BookImages::kTree));
    const auto images = images_of(which, scaled);
    images_text += (images_text.empty() ? "" : "; ") + images->description;
    const int iterations = run.settings.iterations.front();
    const double here = seconds_of([&] {
      map_of_several(*images, run.settings, "bayes", iterations, images->disparities,
                     run.execution);
    });
    const double cells = static_cast<double>(images->left.width()) * images->left.height() *
                         images->disparities.count() * std::max(1, iterations);
    comparisons.push_back(
        {fmt::format("{}: image size, disparities, images, iterations", name),
         fmt::format("{}, 5, 50", size),
         fmt::format("{}, {}, {}, {}", size_text(*images), images->disparities.count(),
                     images->more.size() + 2, iterations)});
    comparisons.push_back({fmt::format("{}: time", name), seconds, time_text(here)});
    comparisons.push_back({fmt::format("{}: per pixel, disparity and iteration", name),
                           "4.5 microseconds on average",
                           fmt::format("{:.3g} nanoseconds", 1e9 * here / cells)});
  }
  return table_of_times(std::move(comparisons), images_text);
}

}  // namespace

std::vector<BookFigure> time_tables() {
  return {{.key = "3.2.6-times",
           .section = "3.2.6",
           .title = "Times of maps and views",
           .book = "Both maps of kids by the method of chapter 5, and a new view.",
           .defaults = {.size_px = default_width(BookImages::kKids),
                        .iterations = {10},
                        .methods = {"gradient"},
                        .seed = 1},
           .images = BookImages::kKids,
           .make = make_view_times},
          {.key = "5.7-times",
           .section = "5.7",
           .title = "Times of the evidence measure",
           .book = "Evidence for one displacement, and what a simpler norm gains.",
           .defaults = {.size_px = 512, .seed = 1},
           .method = "gradient",
           .images = BookImages::kStreet,
           .make = make_evidence_times},
          {.key = "6.6-times",
           .section = "6.6",
           .title = "Times of the probabilistic model",
           .book = "Figs. 6.18 and 6.19: 50 iterations from five images.",
           .defaults =
               [] {
                 FigureSettings settings = several_images_settings(BookImages::kTree);
                 settings.methods.clear();
                 return settings;
               }(),
           .method = "bayes",
           .images = BookImages::kTree,
           .make = make_bayes_times}};
}

}  // namespace vantage
