// Bad pixels and time of every method and preset on real scenes with truth, beside OpenCV's
// StereoBM and StereoSGBM with their usual parameters. Both maps are made, cross-checked and filled
// by all contenders; the left one is judged. Prints Markdown tables. The folder of the scenes is
// the only argument (default: beside the repository); scenes that are not there are named.

#include <fmt/format.h>

#include <chrono>
#include <functional>

#include "engine/matching/stereo_matcher.h"
#include "engine/refinement/refinement.h"
#include "perf/peers.h"
#include "perf/scenes.h"

namespace vantage::perf {
namespace {

struct Contender {
  std::string name;
  std::function<DisparityMap(const LoadedScene&, Execution&)> left_map;
  SceneScores sum;
  double seconds = 0;
  std::vector<double> bad_2_visible;
};

Contender ours(const std::string& name, const MatchOptions& options) {
  return {name,
          [options](const LoadedScene& scene, Execution& execution) {
            MatchOptions scene_options = options;
            scene_options.disparities = scene.range;
            DisparityMaps maps;
            StereoMatcher(scene_options, execution).match(scene.left, scene.right, {}, maps);
            return std::move(maps.left);
          },
          {},
          0,
          {}};
}

Contender method(const std::string& name, MatchMethod kind) {
  MatchOptions options;
  options.method = kind;
  return ours("`--method " + name + "`", options);
}

Contender preset(const std::string& name, MatchPreset kind) {
  MatchOptions options;
  options.preset = kind;
  return ours("`--preset " + name + "`", options);
}

/// Cross-check within a pixel and fill, like our own maps.
DisparityMap refined(PeerMaps maps, Execution& execution) {
  Mask left_unmatched;
  Mask right_unmatched;
  cross_check(maps.left.view(), maps.right.view(), 1, execution, left_unmatched, right_unmatched);
  fill_unmatched(left_unmatched, MapSide::kLeft, Fill::kConstant, execution, maps.left);
  return std::move(maps.left);
}

Contender opencv(const std::string& name, std::function<PeerMaps(const LoadedScene&)> maps) {
  return {name,
          [maps = std::move(maps)](const LoadedScene& scene, Execution& execution) {
            cv::setNumThreads(execution.executor().thread_count());
            PeerMaps both = maps(scene);
            cv::setNumThreads(1);
            return refined(std::move(both), execution);
          },
          {},
          0,
          {}};
}

std::vector<Contender> all_contenders() {
  std::vector<Contender> contenders;
  contenders.push_back(method("ssd", MatchMethod::kSsd));
  contenders.push_back(method("gradient", MatchMethod::kGradient));
  contenders.push_back(method("diffusion", MatchMethod::kDiffusion));
  contenders.push_back(method("membrane", MatchMethod::kMembrane));
  contenders.push_back(method("local-stopping", MatchMethod::kLocalStopping));
  contenders.push_back(method("bayes", MatchMethod::kBayes));
  contenders.push_back(preset("fast", MatchPreset::kFast));
  contenders.push_back(preset("balanced", MatchPreset::kBalanced));
  contenders.push_back(preset("quality", MatchPreset::kQuality));
  contenders.push_back(opencv("OpenCV StereoBM, block 15", [](const LoadedScene& scene) {
    return bm_maps(to_opencv(to_grey(scene.left)), to_opencv(to_grey(scene.right)), scene.range,
                   15);
  }));
  const auto add_sgbm = [&](const std::string& name, int mode) {
    contenders.push_back(opencv(name, [mode](const LoadedScene& scene) {
      return sgbm_maps(to_opencv(scene.left), to_opencv(scene.right), scene.range, 5, mode);
    }));
  };
  add_sgbm("OpenCV StereoSGBM, block 5", cv::StereoSGBM::MODE_SGBM);
  add_sgbm("OpenCV StereoSGBM, three-way, block 5", cv::StereoSGBM::MODE_SGBM_3WAY);
  return contenders;
}

void run(Contender& contender, const LoadedScene& scene, Execution& execution) {
  contender.left_map(scene, execution);  // warm-up
  const auto begin = std::chrono::steady_clock::now();
  const DisparityMap map = contender.left_map(scene, execution);
  contender.seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const SceneScores scores = score(map, scene);
  for (std::size_t i = 0; i < 2; ++i) {
    contender.sum.visible[i] += scores.visible[i];
    contender.sum.all[i] += scores.all[i];
    contender.sum.near_discontinuity[i] += scores.near_discontinuity[i];
  }
  contender.bad_2_visible.push_back(scores.visible[1]);
}

void print(const std::vector<Contender>& contenders, const std::vector<std::string>& names) {
  const double n = static_cast<double>(names.size());
  fmt::print("Means over {} scenes, bad pixels in %, both maps in ms:\n\n", names.size());
  fmt::print(
      "| | visible: bad 1 | bad 2 | all: bad 1 | bad 2 | near edges: bad 1 | bad 2 | ms |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const Contender& c : contenders) {
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} |\n", c.name,
               c.sum.visible[0] / n, c.sum.visible[1] / n, c.sum.all[0] / n, c.sum.all[1] / n,
               c.sum.near_discontinuity[0] / n, c.sum.near_discontinuity[1] / n,
               c.seconds / n * 1e3);
  }
  fmt::print("\nBad 2 of visible pixels by scene:\n\n|");
  for (const std::string& name : names) {
    fmt::print(" | {}", name);
  }
  fmt::print(" |\n|---|");
  for (std::size_t i = 0; i < names.size(); ++i) {
    fmt::print("---|");
  }
  for (const Contender& c : contenders) {
    fmt::print("\n| {}", c.name);
    for (const double bad : c.bad_2_visible) {
      fmt::print(" | {:.1f}", bad);
    }
    fmt::print(" |");
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage;
  using namespace vantage::perf;
  const std::filesystem::path folder = argc > 1 ? argv[1] : VANTAGE_SHARED_DATA;
  Execution execution({});
  std::vector<Contender> contenders = all_contenders();
  std::vector<std::string> names;
  for (const TrueScene& scene : true_scenes()) {
    if (!std::filesystem::exists(folder / scene.name / scene.left)) {
      fmt::print(stderr, "scene {} is not in {}\n", scene.name, folder.string());
      continue;
    }
    const LoadedScene loaded = load_scene(scene, folder);
    names.push_back(scene.name);
    for (Contender& contender : contenders) {
      run(contender, loaded, execution);
    }
  }
  if (names.empty()) {
    return 1;
  }
  print(contenders, names);
  return 0;
}
