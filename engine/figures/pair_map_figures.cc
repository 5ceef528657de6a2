#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/pair_runs.h"
#include "engine/plot/picture_sheet.h"

namespace vantage {
namespace {

/// A run, and what differs from the other runs of its figure.
struct TitledRun {
  std::string title;
  ComparisonRun run;
};

std::string title_of(const ComparisonRun& run, const std::string& variant) {
  std::string title = fmt::format("{}, {}", run.pair, run.method);
  if (!variant.empty()) {
    title += ", " + variant;
  }
  if (compared_method(run.method).is_iterative) {
    title += fmt::format(", n = {}", run.iterations);
  }
  return title +
         (run.noise_sigma > 0 ? fmt::format(", noise {}", noise_label(run.noise_sigma)) : "");
}

std::vector<TitledRun> titled(std::vector<ComparisonRun> runs, const std::string& variant) {
  std::vector<TitledRun> result;
  for (ComparisonRun& run : runs) {
    std::string title = title_of(run, variant);
    result.push_back({std::move(title), std::move(run)});
  }
  return result;
}

/// Share of the pixels whose disparity is within 1/2 of that of background or square, percent.
double share_at_levels(const DisparityMap& map, const std::string& pair) {
  const BookPairOptions options = book_pair_options(pair);
  double percent = 0;
  for (const int level : {options.background_disparity_px, options.front_disparity_or_default()}) {
    percent += percent_where(map, [level](int /*x*/, int /*y*/, float value) {
      return std::abs(value - static_cast<float>(level)) <= 0.5F;
    });
  }
  return percent;
}

FigureContent show_maps(const std::string& title, const std::vector<TitledRun>& runs) {
  FigureContent content;
  std::vector<SheetPicture> pictures;
  FigureTable table{"",
                    {"map", "mean_absolute_px", "rms_px", "bad_percent",
                     "within_half_pixel_of_a_true_level_percent"}};
  for (const auto& [name, run] : runs) {
    const BookPair pair = make_book_pair(book_pair_options(run.pair));
    pictures.push_back({name, grey_picture(run.map.view(), static_cast<float>(pair.search.min),
                                           static_cast<float>(pair.search.max))});
    table.add(name, fmt::format("{:.4f}", run.scores.average_px),
              fmt::format("{:.4f}", run.scores.rms_px),
              fmt::format("{:.2f}", run.scores.bad_0_5_percent),
              fmt::format("{:.2f}", share_at_levels(run.map, run.pair)));
  }
  constexpr int kColumns = 4;
  constexpr double kPictureWidth = 200;
  content.pictures.push_back(
      {"maps", draw_picture_sheet(title, pictures, kColumns, kPictureWidth)});
  content.tables.push_back(std::move(table));
  return content;
}

const TitledRun* find_run(const std::vector<TitledRun>& runs, const std::string& pair,
                          const std::string& part_of_title) {
  const auto found = std::ranges::find_if(runs, [&](const TitledRun& run) {
    return run.run.pair == pair && run.title.find(part_of_title) != std::string::npos;
  });
  return found == runs.end() ? nullptr : &*found;
}

bool reads_window(const std::string& method, MethodOverrides parameters) {
  parameters.window_px = 3;
  return compared_options(compared_method(method), BookPattern::kRamp, 1, parameters)
      .parameters.window_px.has_value();
}

FigureContent make_windows(const FigureRun& run) {
  const std::optional<int> chosen = run.settings.parameters.window_px;
  FigureSettings with_windows = run.settings;
  FigureSettings without = run.settings;
  std::erase_if(with_windows.methods, [&run](const std::string& method) {
    return !reads_window(method, run.settings.parameters);
  });
  std::erase_if(without.methods, [&run](const std::string& method) {
    return reads_window(method, run.settings.parameters);
  });
  std::vector<TitledRun> runs;
  const auto add = [&](const FigureSettings& settings, std::optional<int> window_px) {
    if (settings.methods.empty()) {
      return true;
    }
    MethodOverrides more;
    more.window_px = window_px;
    auto some = titled(runs_of({settings, run.execution, run.stop, run.given}, more),
                       window_px ? fmt::format("w = {}", *window_px) : "");
    std::ranges::move(some, std::back_inserter(runs));
    return !some.empty();
  };
  for (const int window_px : chosen ? std::vector{*chosen} : std::vector{3, 7}) {
    if (!add(with_windows, window_px)) {
      return {};
    }
  }
  if (!add(without, std::nullopt)) {
    return {};
  }
  FigureContent content = show_maps("Disparities of SSD", runs);
  const auto levels = [](const TitledRun& large) {
    return fmt::format("w = 7: {:.0f} % of the map within 1/2 of a true level",
                       share_at_levels(large.run.map, large.run.pair));
  };
  for (const std::string& pair : run.settings.pairs) {
    const TitledRun* const small = find_run(runs, pair, "w = 3");
    const TitledRun* const large = find_run(runs, pair, "w = 7");
    if (small == nullptr || large == nullptr) {
      continue;
    }
    if (pair.starts_with("ramp")) {
      content.comparisons.push_back(
          {pair, "disparities are smoothed across the boundaries", levels(*large)});
    } else if (pair.starts_with("rds")) {
      content.comparisons.push_back(
          {pair, "outlines are blurred, the two levels are recovered", levels(*large)});
    }
    content.comparisons.push_back(
        {pair + ": the larger window", "less noise, more blur",
         fmt::format("bad points {:.1f} % with w = 3, {:.1f} % with w = 7",
                     small->run.scores.bad_0_5_percent, large->run.scores.bad_0_5_percent)});
  }
  return content;
}

FigureContent make_membrane_maps(const FigureRun& run) {
  const auto runs = titled(runs_of(run), "");
  if (runs.empty()) {
    return {};
  }
  FigureContent content = show_maps("Disparities of the membrane model", runs);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const bool is_last =
        i + 1 == runs.size() || !differ_in_iterations(runs[i].run, runs[i + 1].run);
    if (!is_last || !differ_in_iterations(runs[i - 1].run, runs[i].run)) {
      continue;
    }
    content.comparisons.push_back(
        {fmt::format("{}, {}: n = {} and n = {}", runs[i].run.pair, runs[i].run.method,
                     runs[i - 1].run.iterations, runs[i].run.iterations),
         "almost identical",
         fmt::format("{:.2f} % of the pixels differ by more than 1/2",
                     percent_where(runs[i].run.map, [&](int x, int y, float value) {
                       return std::abs(value - runs[i - 1].run.map.at(x, y)) > 0.5F;
                     }))});
  }
  return content;
}

FigureContent make_bayes_maps(const FigureRun& run) {
  const auto runs = titled(runs_of(run), "");
  if (runs.empty()) {
    return {};
  }
  FigureContent content = show_maps("Disparities of the probabilistic model", runs);
  for (const auto& [title, one] : runs) {
    content.comparisons.push_back(
        {title, "the pattern is recovered",
         fmt::format("{:.2f} % bad points of the visible ones", one.scores.bad_0_5_percent)});
  }
  return content;
}

}  // namespace

std::vector<BookFigure> pair_map_figures() {
  const FigureSettings maps = {.size_px = 100,
                               .iterations = {10},
                               .noise_sigmas = {kBookNoise},
                               .methods = {},
                               .pairs = {"ramp-square", "rds-square"},
                               .seed = 1};
  FigureSettings windows = maps;
  windows.methods = {"ssd"};
  windows.parameters.subpixel = Subpixel::kParabola;
  FigureSettings membrane = maps;
  membrane.methods = {"membrane"};
  membrane.iterations = {5, 10};
  FigureSettings bayes = maps;
  bayes.methods = {"bayes"};
  return {{.key = "6.5",
           .section = "6.2",
           .title = "SSD with small and large windows",
           .book = "Maps of ramp and rds with windows of 3 and 7 pixels, as surfaces. Sub-pixel "
                   "disparities by parabolas.",
           .defaults = windows,
           .make = make_windows},
          {.key = "6.8",
           .section = "6.3.1",
           .title = "The membrane model",
           .book = "Maps of ramp and rds after 10 iterations with lambda = 0.15 and beta = 0.5, in "
                   "grey levels and as surfaces. Results at n = 5 are almost identical.",
           .defaults = membrane,
           .make = make_membrane_maps},
          {.key = "6.13",
           .section = "6.5.3",
           .title = "The probabilistic model",
           .book = "Maps of ramp (sigma_M = 2) and rds (sigma_M = 20) after 10 iterations with "
                   "epsilon_M = 0.1, sigma_P = 0.1 and epsilon_P = 0.01, in grey levels and as "
                   "surfaces.",
           .defaults = bayes,
           .make = make_bayes_maps}};
}

}  // namespace vantage
