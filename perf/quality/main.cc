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

#include "engine/error.h"
#include "engine/options/setting_value.h"
#include "engine/simd.h"
#include "perf/command_line.h"
#include "perf/default_paths.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/picture_page.h"
#include "perf/quality/results.h"
#include "perf/quality/sgbm_search.h"
#include "perf/quality/sub_pixel.h"
#include "perf/quality/view_tables.h"
#include "perf/stopwatch.h"

namespace vantage::perf {
namespace {

struct Settings {
  std::filesystem::path data = kDefaultData;
  std::string experiments = kDefaultExperiments;
  std::optional<std::string> only;
  std::optional<std::string> peers;
  std::optional<std::string> scenes;
  bool tuning = false;
  bool held_out = false;
  bool no_time = false;
  bool left_only = false;
  int rounds = 3;
  int threads = scheduler::detect_machine().hardware_threads;
  std::optional<std::string> isa;
  std::optional<std::string> grey;
  std::optional<std::string> csv;
  bool sub_pixel = false;
  bool views = false;
  bool search_peers = false;
  std::optional<std::filesystem::path> html;
  std::optional<std::filesystem::path> before;
};

Settings read_settings(int argc, char** argv) {
  CommandLine line(
      "Bad pixels and time of experiments and of StereoSGBM on scenes with truth, as Markdown");
  Settings settings;
  line.option("--data", settings.data, "Folder of the scenes; missing scenes are left out");
  line.option("--experiments", settings.experiments, "TOML file of settings of `vantage match`");
  line.option("--only", settings.only, "Only these experiments: NAME,... or none");
  line.option("--peers", settings.peers, "Only these settings of StereoSGBM: NAME,... or none");
  line.option("--scenes", settings.scenes, "Only these scenes or groups: NAME,...");
  line.flag("--tuning", settings.tuning, "Only scenes that parameters are chosen on");
  line.flag("--held-out", settings.held_out, "Only the other scenes");
  line.flag("--no-time", settings.no_time, "Do not measure time");
  line.flag(
      "--left-only", settings.left_only,
      "Time the left map alone, checked against as much of the right one as it takes; without "
      "it both maps. Maps of StereoSGBM are timed without post-processing");
  line.number("--rounds", settings.rounds, "Rounds for the medians, after one that warms up");
  line.threads(settings.threads);
  line.option("--isa", settings.isa, "Instruction set, as in `vantage --isa`; not for OpenCV");
  line.option("--grey", settings.grey,
              "peers: StereoSGBM matches grey images; all: everything does; without it colour");
  line.option("--csv", settings.csv, "Write all figures of each contender and scene to this file");
  line.flag("--sub-pixel", settings.sub_pixel, "Fractions of disparities and their errors, too");
  line.flag("--views", settings.views,
            "Instead: views between the cameras, from true maps and from all contenders' maps");
  line.option("--html", settings.html,
              "Instead: FOLDER/index.html with each contender's maps, errors and new views");
  line.option("--before", settings.before,
              "With --html: a folder that another build made, shown beside");
  line.flag("--search-peers", settings.search_peers,
            "Instead: the search for StereoSGBM's post-processing");
  line.parse(argc, argv);
  return settings;
}

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
  const std::vector<std::string> names = split(*list, ',');
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

std::vector<const TrueScene*> chosen_scenes(const Settings& settings) {
  std::vector<const TrueScene*> scenes;
  for (const TrueScene& scene : true_scenes()) {
    scenes.push_back(&scene);
  }
  scenes = chosen(scenes, settings.scenes, "--scenes", [](const TrueScene* scene) {
    return std::set<std::string>{scene->name, scene->group};
  });
  std::erase_if(scenes, [&](const TrueScene* scene) {
    if ((settings.tuning && !scene->is_tuning) || (settings.held_out && scene->is_tuning)) {
      return true;
    }
    const bool is_missing = !std::filesystem::exists(settings.data / scene->folder);
    if (is_missing) {
      fmt::print(stderr, "scene {} left out: no folder {}\n", scene->name,
                 (settings.data / scene->folder).string());
    }
    return is_missing;
  });
  if (scenes.empty()) {
    throw UsageError("no scenes are left");
  }
  return scenes;
}

std::vector<MapContender> chosen_contenders(const Settings& settings,
                                            const std::vector<SgbmSetting>& peers) {
  std::vector<MapContender> contenders =
      chosen(experiments(settings.experiments), settings.only, "--only", name_of<MapContender>);
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
    const MatchedMap& map = makers[i]->maps().left;
    results.outcomes[i].push_back(
        {bad_pixels(map, loaded), times[i],
         scene.is_fractional ? sub_pixel_figures(map.disparity_px, loaded) : SubPixelFigures()});
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

void run(const Settings& settings) {
  const std::vector<SgbmSetting> peers =
      chosen(sgbm_settings(), settings.peers, "--peers", name_of<SgbmSetting>);
  Results results{chosen_contenders(settings, peers), chosen_scenes(settings), {}, {}};
  Execution execution({.threads = settings.threads});
  const int rounds = settings.no_time ? 0 : settings.rounds;
  const TimedMaps timed = settings.left_only ? TimedMaps::kLeft : TimedMaps::kBoth;
  if (settings.isa) {
    force_instruction_set(*settings.isa);
  }
  const GreyImages grey = grey_images(settings.grey);
  if (grey != GreyImages::kNobody && (settings.views || settings.search_peers)) {
    throw UsageError("--grey cannot be combined with --views or --search-peers");
  }
  if (settings.views && (settings.csv || settings.sub_pixel)) {
    throw UsageError("--views cannot be combined with --csv or --sub-pixel");
  }
  if (settings.before && !settings.html) {
    throw UsageError("--before needs --html");
  }
  if (settings.html &&
      (settings.views || settings.search_peers || settings.csv || settings.sub_pixel)) {
    throw UsageError("--html cannot be combined with other results");
  }
  if (settings.search_peers && settings.sub_pixel) {
    throw UsageError("--search-peers cannot be combined with --sub-pixel");
  }

  if (settings.search_peers) {
    search_sgbm_post_processing(peers, results.scenes, settings.data, settings.csv.value_or(""),
                                execution);
    return;
  }
  if (settings.html) {
    write_picture_page(results.contenders, results.scenes, settings.data,
                       {.folder = *settings.html, .before = settings.before}, execution);
    return;
  }
  if (settings.views) {
    print_view_tables(results.contenders, results.scenes, settings.data, execution);
    return;
  }
  results.outcomes.resize(results.contenders.size());
  for (const TrueScene* scene : results.scenes) {
    fmt::print(stderr, "{}\n", scene->name);
    judge(*scene, settings.data, grey, rounds, timed, execution, results);
  }
  print_tables(results);
  if (settings.sub_pixel) {
    print_sub_pixel_tables(results);
  }
  if (settings.csv) {
    write_csv(results, *settings.csv);
  }
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  try {
    vantage::perf::run(vantage::perf::read_settings(argc, argv));
  } catch (const vantage::UsageError& error) {
    fmt::print(stderr, "quality: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "quality: {}\n", error.what());
    return 1;
  }
  return 0;
}
