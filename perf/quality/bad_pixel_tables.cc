#include "perf/quality/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "perf/quality/markdown.h"
#include "perf/quality/scene_groups.h"

namespace vantage::perf {
namespace {

// Indices into kBadAbovePx.
constexpr std::size_t kHalf = 0;
constexpr std::size_t kOne = 1;
constexpr std::size_t kTwo = 2;

using Figure = std::function<double(const Outcome&)>;

struct Column {
  std::string title;
  Figure figure;
};

const std::vector<Column>& bad_columns() {
  static const std::vector<Column> columns = {
      {"visible: bad 0.5", [](const Outcome& o) { return o.bad.visible[kHalf]; }},
      {"bad 1", [](const Outcome& o) { return o.bad.visible[kOne]; }},
      {"bad 2", [](const Outcome& o) { return o.bad.visible[kTwo]; }},
      {"all: bad 1", [](const Outcome& o) { return o.bad.all[kOne]; }},
      {"bad 2", [](const Outcome& o) { return o.bad.all[kTwo]; }},
      {"D1", [](const Outcome& o) { return o.bad.d1; }},
      {"hidden: bad 1", [](const Outcome& o) { return o.bad.hidden[kOne]; }},
      {"visible unmatched: bad 1", [](const Outcome& o) { return o.bad.visible_unmatched[kOne]; }},
      {"near edges: bad 1", [](const Outcome& o) { return o.bad.near_discontinuity[kOne]; }},
  };
  return columns;
}

/// Columns that must be below all settings of StereoSGBM.
const std::vector<Column>& contested_columns() {
  static const std::vector<Column> columns = {
      {"visible: bad 1", [](const Outcome& o) { return o.bad.visible[kOne]; }},
      {"bad 2", [](const Outcome& o) { return o.bad.visible[kTwo]; }},
      {"all: bad 1", [](const Outcome& o) { return o.bad.all[kOne]; }},
      {"bad 2", [](const Outcome& o) { return o.bad.all[kTwo]; }},
  };
  return columns;
}

double milliseconds(const Outcome& outcome, double FrameTime::*time) {
  return outcome.time ? *outcome.time.*time * 1e3 : std::numeric_limits<double>::quiet_NaN();
}

double wall_ms(const Outcome& outcome) { return milliseconds(outcome, &FrameTime::wall); }
double processor_ms(const Outcome& outcome) { return milliseconds(outcome, &FrameTime::processor); }

/// Mean over the scenes that have the value; NaN if none has.
double mean(const std::vector<Outcome>& outcomes, const std::vector<std::size_t>& scenes,
            const Figure& figure) {
  double sum = 0;
  double count = 0;
  for (const std::size_t scene : scenes) {
    const double value = figure(outcomes[scene]);
    if (std::isfinite(value)) {
      sum += value;
      ++count;
    }
  }
  return sum / count;
}

/// Minimum over StereoSGBM's settings; infinite if there are none.
double min_of_sgbm(const Results& results, const std::function<double(std::size_t)>& figure) {
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    if (results.contenders[i].is_sgbm) {
      min = std::min(min, figure(i));
    }
  }
  return min;
}

void print_group(const Results& results, const SceneGroup& group) {
  fmt::print("\n{}, {} scenes:\n\n", group.name, group.scenes.size());
  std::vector<std::string> titles;
  for (const Column& column : bad_columns()) {
    titles.push_back(column.title);
  }
  titles.insert(titles.end(), {"visible bad 1 ÷ best SGBM", "ms", "processor ms"});
  print_header(titles);
  const Figure bad_1_visible = contested_columns().front().figure;
  const double best_sgbm = min_of_sgbm(results, [&](std::size_t contender) {
    return mean(results.outcomes[contender], group.scenes, bad_1_visible);
  });
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    fmt::print("| {} |", results.contenders[i].name);
    for (const Column& column : bad_columns()) {
      fmt::print(" {} |", cell(mean(results.outcomes[i], group.scenes, column.figure), 2));
    }
    const double ratio = std::isfinite(best_sgbm)
                             ? mean(results.outcomes[i], group.scenes, bad_1_visible) / best_sgbm
                             : std::numeric_limits<double>::quiet_NaN();
    fmt::print(" {} | {} | {} |\n", cell(ratio, 2),
               cell(mean(results.outcomes[i], group.scenes, wall_ms), 1),
               cell(mean(results.outcomes[i], group.scenes, processor_ms), 1));
  }
}

void print_wins(const Results& results) {
  fmt::print("\nScenes of {} with fewer bad pixels than every setting of StereoSGBM:\n\n",
             results.scenes.size());
  std::vector<std::string> titles;
  for (const Column& column : contested_columns()) {
    titles.push_back(column.title);
  }
  titles.emplace_back("lost on visible bad 1 or 2");
  print_header(titles);
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    if (results.contenders[i].is_sgbm) {
      continue;
    }
    fmt::print("| {} |", results.contenders[i].name);
    std::vector<bool> is_lost(results.scenes.size());
    for (std::size_t column = 0; column < contested_columns().size(); ++column) {
      const Figure& figure = contested_columns()[column].figure;
      int won = 0;
      for (std::size_t scene = 0; scene < results.scenes.size(); ++scene) {
        const double best_sgbm = min_of_sgbm(results, [&](std::size_t contender) {
          return figure(results.outcomes[contender][scene]);
        });
        const bool is_won = figure(results.outcomes[i][scene]) < best_sgbm;
        won += is_won ? 1 : 0;
        is_lost[scene] = is_lost[scene] || (!is_won && column < 2);
      }
      fmt::print(" {} |", won);
    }
    for (std::size_t scene = 0; scene < results.scenes.size(); ++scene) {
      fmt::print("{}", is_lost[scene] ? " " + results.scenes[scene]->name : "");
    }
    fmt::print(" |\n");
  }
}

void print_by_scene(const Results& results, const Column& column, int decimals) {
  fmt::print("\n{} by scene:\n\n", column.title);
  std::vector<std::string> titles;
  for (const TrueScene* scene : results.scenes) {
    titles.push_back(scene->name + (scene->is_tuning ? " (t)" : ""));
  }
  print_header(titles);
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    fmt::print("| {} |", results.contenders[i].name);
    for (const Outcome& outcome : results.outcomes[i]) {
      fmt::print(" {} |", cell(column.figure(outcome), decimals));
    }
    fmt::print("\n");
  }
}

}  // namespace

void print_tables(const Results& results) {
  for (const SceneGroup& group : scene_groups(results.scenes)) {
    print_group(results, group);
  }
  if (std::ranges::any_of(results.contenders, &MapContender::is_sgbm)) {
    print_wins(results);
  }
  print_by_scene(results, {"Bad 1 of visible pixels", contested_columns()[0].figure}, 2);
  print_by_scene(results, {"Bad 2 of visible pixels", contested_columns()[1].figure}, 2);
  print_by_scene(results, {"Bad 1 of all pixels", contested_columns()[2].figure}, 2);
  print_by_scene(results, {"Bad 2 of all pixels", contested_columns()[3].figure}, 2);
  print_by_scene(
      results, {"Bad 1 of hidden pixels", [](const Outcome& o) { return o.bad.hidden[kOne]; }}, 2);
  print_by_scene(results,
                 {"Bad 1 of visible unmatched pixels",
                  [](const Outcome& o) { return o.bad.visible_unmatched[kOne]; }},
                 2);
  print_by_scene(results,
                 {"Median of estimate − truth (px), visible pixels",
                  [](const Outcome& o) { return o.bad.median_error_px; }},
                 3);
  if (results.outcomes.front().front().time) {
    print_by_scene(results, {"Milliseconds for both maps", wall_ms}, 1);
    print_by_scene(results, {"Milliseconds of processors for both maps", processor_ms}, 1);
  }
}

}  // namespace vantage::perf
