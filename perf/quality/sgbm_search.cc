#include "perf/quality/sgbm_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "engine/error.h"
#include "perf/quality/bad_pixels.h"

namespace vantage::perf {
namespace {

// Not tried on all scenes, because they made little difference or lost for all settings on six of
// them: no disp12MaxDiff (our cross-check refuses the same pixels; OpenCV 4.6 treats values ≤ 0 as
// 1 anyway), a cross-check at 1.5 px, filling at constant depth, uniqueness 5 and 15.
constexpr std::array kUniquenessPercent = {0, 10, 20};

struct Speckles {
  int opencv_px;
  int opencv_range_px;
  int ours_px;
};
constexpr std::array<Speckles, 6> kSpeckles = {
    {{0, 0, 0}, {0, 0, 100}, {100, 1, 0}, {100, 2, 0}, {100, 32, 0}, {200, 2, 0}}};

/// One set of post-processing parameters and its results.
struct Tried {
  SgbmPostProcessing post_processing;
  std::vector<BadPixels> of_scenes;

  [[nodiscard]] double mean_bad_1(BadPercent BadPixels::*pixels) const {
    double sum = 0;
    for (const BadPixels& bad : of_scenes) {
      sum += (bad.*pixels)[1];
    }
    return sum / static_cast<double>(of_scenes.size());
  }
  [[nodiscard]] double criterion() const {
    return mean_bad_1(&BadPixels::visible) + mean_bad_1(&BadPixels::all);
  }
};

PeerDisparities copy(const PeerDisparities& disparities) {
  return {disparities.left.clone(), disparities.right.clone()};
}

/// Evaluates all sets with one uniqueness on the scene.
void try_uniqueness(SgbmSetting setting, const LoadedScene& scene, Execution& execution,
                    std::vector<Tried>& tried) {
  setting.post_processing = tried.front().post_processing;
  const PeerDisparities winners =
      both_disparities(*make_sgbm_matcher(setting, scene.pair), scene.pair.left_opencv,
                       scene.pair.right_opencv, scene.pair.range);
  DisparityMaps maps;
  for (Tried& one : tried) {
    PeerDisparities filtered = copy(winners);
    filter_opencv_speckles(one.post_processing, scene.pair.range, filtered.left);
    filter_opencv_speckles(one.post_processing, scene.pair.range, filtered.right);
    refine_peer_maps(one.post_processing, scene.pair, filtered, execution, maps);
    one.of_scenes.push_back(bad_pixels(maps.left, scene));
  }
}

/// Prints the best sets first.
void print_best(const SgbmSetting& setting, const std::vector<Tried>& tried) {
  constexpr std::size_t kShown = 5;
  fmt::print("\n{}: means of bad 1 over {} scenes, visible and all\n", setting.name,
             tried.front().of_scenes.size());
  for (std::size_t i = 0; i < std::min(kShown, tried.size()); ++i) {
    fmt::print("  {:6.3f} {:6.3f}  {}\n", tried[i].mean_bad_1(&BadPixels::visible),
               tried[i].mean_bad_1(&BadPixels::all), to_text(tried[i].post_processing));
  }
}

void write_csv(const SgbmSetting& setting, const std::vector<Tried>& tried,
               const std::vector<const TrueScene*>& scenes, std::ofstream& csv) {
  for (const Tried& one : tried) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      csv << fmt::format("{},\"{}\",{},{:.4f},{:.4f}\n", setting.name, to_text(one.post_processing),
                         scenes[i]->name, one.of_scenes[i].visible[1], one.of_scenes[i].all[1]);
    }
  }
}

}  // namespace

void search_sgbm_post_processing(const std::vector<SgbmSetting>& settings,
                                 const std::vector<const TrueScene*>& scenes,
                                 const std::filesystem::path& data, const std::string& csv,
                                 Execution& execution) {
  std::vector<std::vector<Tried>> of_uniqueness;
  for (const int uniqueness_percent : kUniquenessPercent) {
    of_uniqueness.emplace_back();
    for (const Speckles& speckles : kSpeckles) {
      of_uniqueness.back().push_back(
          {{uniqueness_percent, speckles.opencv_px, speckles.opencv_range_px, speckles.ours_px},
           {}});
    }
  }
  std::vector<std::vector<std::vector<Tried>>> tried(settings.size(), of_uniqueness);
  cv::setNumThreads(1);  // instead, several matchers run side by side
  for (const TrueScene* scene : scenes) {
    const LoadedScene loaded = load_scene(*scene, data);
    fmt::print(stderr, "{}\n", scene->name);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      execution.executor().parallel_for(static_cast<int>(of_uniqueness.size()), [&](int index) {
        try_uniqueness(settings[i], loaded, execution, tried[i][static_cast<std::size_t>(index)]);
      });
    }
  }
  std::ofstream file;
  if (!csv.empty()) {
    file.open(csv);
    file << "setting,post_processing,scene,visible_bad_1,all_bad_1\n";
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    std::vector<Tried> all;
    for (const std::vector<Tried>& with_equal : tried[i]) {
      all.insert(all.end(), with_equal.begin(), with_equal.end());
    }
    std::ranges::sort(all, {}, &Tried::criterion);
    print_best(settings[i], all);
    if (file.is_open()) {
      write_csv(settings[i], all, scenes, file);
    }
  }
  if (!csv.empty() && !file.flush()) {
    throw Error(fmt::format("{}: cannot be written", csv));
  }
}

}  // namespace vantage::perf
