// Evaluates methods, presets and experiments (perf/experiments.toml) on scenes with truth, beside
// every setting of OpenCV's StereoSGBM, each with its best post-processing. Both maps are computed;
// the left one is evaluated, or with --views the views synthesised from both. Prints Markdown
// tables; see perf/README.md for options.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/setting_value.h"
#include "engine/error.h"
#include "engine/simd.h"
#include "perf/command_line.h"
#include "perf/default_paths.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/results.h"
#include "perf/quality/sgbm_search.h"
#include "perf/quality/sub_pixel.h"
#include "perf/quality/view_tables.h"
#include "perf/stopwatch.h"

namespace vantage::perf {
namespace {

constexpr const char* kUsage =
    "quality [--data FOLDER] [--experiments FILE.toml] [--only NAME,…|none] [--peers NAME,…|none] "
    "[--scenes NAME|GROUP,…] [--tuning] [--held-out] [--no-time] [--left-only] [--rounds N] "
    "[--threads N] [--isa NAME] [--grey peers|all] [--csv FILE] [--sub-pixel] [--views] "
    "[--search-peers]";

/// Elements of `all` that a list names, in the order of `all`; all without a list. `names_of`
/// returns the names of an element.
template <typename T, typename NamesOf>
std::vector<T> chosen(const std::vector<T>& all, const std::optional<std::string>& list,
                      const char* option, const NamesOf& names_of) {
  if (!list) {
    return all;
  }
  std::set<std::string> known = {"none"};
  for (const T& one : all) {
    known.merge(std::set<std::string>(names_of(one)));
  }
  const std::vector<std::string> names = apps::split(*list, ',');
  for (const std::string& name : names) {
    if (!known.contains(name)) {
      throw UsageError(
          fmt::format("{} names '{}', expected some of {}", option, name, fmt::join(known, ", ")));
    }
  }
  std::vector<T> result;
  std::ranges::copy_if(all, std::back_inserter(result), [&](const T& one) {
    const std::set<std::string> own = names_of(one);
    return std::ranges::any_of(names, [&](const std::string& name) { return own.contains(name); });
  });
  return result;
}

template <typename T>
std::set<std::string> name_of(const T& one) {
  return {one.name};
}

std::vector<const TrueScene*> chosen_scenes(CommandLine& line, const std::filesystem::path& data) {
  std::vector<const TrueScene*> scenes;
  for (const TrueScene& scene : true_scenes()) {
    scenes.push_back(&scene);
  }
  scenes = chosen(scenes, line.text("--scenes"), "--scenes", [](const TrueScene* scene) {
    return std::set<std::string>{scene->name, scene->group};
  });
  const bool only_tuning = line.flag("--tuning");
  const bool only_held_out = line.flag("--held-out");
  std::erase_if(scenes, [&](const TrueScene* scene) {
    if ((only_tuning && !scene->is_tuning) || (only_held_out && scene->is_tuning)) {
      return true;
    }
    const bool is_missing = !std::filesystem::exists(data / scene->folder);
    if (is_missing) {
      fmt::print(stderr, "scene {} left out: no folder {}\n", scene->name,
                 (data / scene->folder).string());
    }
    return is_missing;
  });
  if (scenes.empty()) {
    throw UsageError("no scenes are left");
  }
  return scenes;
}

std::vector<MapContender> chosen_contenders(CommandLine& line,
                                            const std::vector<SgbmSetting>& peers) {
  const std::string file = line.text("--experiments").value_or(kDefaultExperiments);
  std::vector<MapContender> contenders =
      chosen(experiments(file), line.text("--only"), "--only", name_of<MapContender>);
  for (const SgbmSetting& peer : peers) {
    contenders.push_back(sgbm_contender(peer));
  }
  if (contenders.empty()) {
    throw UsageError("no contenders are left");
  }
  return contenders;
}

/// Medians of `rounds` rounds with all contenders in turn, after one round that warms up and
/// computes both maps; empty without rounds.
std::vector<std::optional<FrameTime>> time_in_turn(
    const std::vector<std::unique_ptr<MapMaker>>& makers, int rounds, TimedMaps timed) {
  std::vector<std::vector<FrameTime>> times(makers.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < makers.size(); ++i) {
      const Stopwatch watch;
      makers[i]->match(round > 0 ? timed : TimedMaps::kBoth);
      if (round > 0) {
        times[i].push_back(watch.per_frame(1));
      }
    }
  }
  std::vector<std::optional<FrameTime>> medians(makers.size());
  for (std::size_t i = 0; i < makers.size() && rounds > 0; ++i) {
    medians[i] = FrameTime{median(of(times[i], &FrameTime::wall)),
                           median(of(times[i], &FrameTime::processor))};
  }
  return medians;
}

/// Adds the outcome of every contender. Without rounds nothing is timed.
void judge(const TrueScene& scene, const std::filesystem::path& data, GreyImages grey, int rounds,
           TimedMaps timed, Execution& execution, Results& results) {
  LoadedScene loaded = load_scene(scene, data);
  make_grey(loaded.pair, grey);
  std::vector<std::unique_ptr<MapMaker>> makers;
  for (const MapContender& contender : results.contenders) {
    makers.push_back(contender.prepare(loaded.pair, execution));
  }
  const std::vector<std::optional<FrameTime>> times = time_in_turn(makers, rounds, timed);
  for (std::size_t i = 0; i < makers.size(); ++i) {
    const DisparityMap& map = makers[i]->maps().left.disparity_px;
    results.outcomes[i].push_back(
        {bad_pixels(map, loaded), times[i],
         scene.is_fractional ? sub_pixel_figures(map, loaded) : SubPixelFigures()});
  }
  results.truth_sub_pixel.push_back(scene.is_fractional ? sub_pixel_figures(loaded.truth, loaded)
                                                        : SubPixelFigures());
}

GreyImages grey_images(const std::optional<std::string>& text) {
  if (text && *text != "peers" && *text != "all") {
    throw UsageError(fmt::format("--grey is '{}', expected peers or all", *text));
  }
  return !text ? GreyImages::kNobody : *text == "all" ? GreyImages::kAll : GreyImages::kPeers;
}

void run(CommandLine& line) {
  constexpr int kUsualRounds = 3;
  const std::filesystem::path data = line.text("--data").value_or(kDefaultData);
  const std::vector<SgbmSetting> peers =
      chosen(sgbm_settings(), line.text("--peers"), "--peers", name_of<SgbmSetting>);
  Results results{chosen_contenders(line, peers), chosen_scenes(line, data), {}, {}};
  const int usual_threads = scheduler::detect_machine().hardware_threads;
  Execution execution({.threads = line.number("--threads", usual_threads)});
  const int wanted_rounds = line.number("--rounds", kUsualRounds);
  const int rounds = line.flag("--no-time") ? 0 : wanted_rounds;
  const TimedMaps timed = line.flag("--left-only") ? TimedMaps::kLeft : TimedMaps::kBoth;
  if (const auto isa = line.text("--isa")) {
    force_instruction_set(*isa);
  }
  const GreyImages grey = grey_images(line.text("--grey"));
  const std::optional<std::string> csv = line.text("--csv");
  const bool wants_sub_pixel = line.flag("--sub-pixel");
  const bool wants_views = line.flag("--views");
  const bool searches_peers = line.flag("--search-peers");
  line.finish();
  if (grey != GreyImages::kNobody && (wants_views || searches_peers)) {
    throw UsageError("--grey does not go with --views and --search-peers");
  }
  if ((wants_views && (csv || wants_sub_pixel)) || (searches_peers && wants_sub_pixel)) {
    throw UsageError("--csv does not go with --views, --sub-pixel with neither that nor a search");
  }

  if (searches_peers) {
    search_sgbm_post_processing(peers, results.scenes, data, csv.value_or(""), execution);
    return;
  }
  if (wants_views) {
    print_view_tables(results.contenders, results.scenes, data, execution);
    return;
  }
  results.outcomes.resize(results.contenders.size());
  for (const TrueScene* scene : results.scenes) {
    fmt::print(stderr, "{}\n", scene->name);
    judge(*scene, data, grey, rounds, timed, execution, results);
  }
  print_tables(results);
  if (wants_sub_pixel) {
    print_sub_pixel_tables(results);
  }
  if (csv) {
    write_csv(results, *csv);
  }
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  try {
    vantage::perf::CommandLine line(argc, argv, vantage::perf::kUsage);
    vantage::perf::run(line);
  } catch (const vantage::UsageError& error) {
    fmt::print(stderr, "quality: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "quality: {}\n", error.what());
    return 1;
  }
  return 0;
}
