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

/// What the matcher itself has to be told.
std::vector<SgbmPostProcessing> matcher_variants() {
  std::vector<SgbmPostProcessing> variants;
  for (const int uniqueness_percent : {0, 5, 10, 15, 20}) {
    for (const int disp12_max_diff_px : {1, kNoDisp12Check}) {
      variants.push_back({uniqueness_percent, disp12_max_diff_px, 0, 0, 1, 0, Fill::kMedian});
    }
  }
  return variants;
}

/// All that may follow one of matcher_variants(). Not among them, because they were worse for all
/// settings on the smaller scenes: a cross-check at 1.5 px, and filling at constant depth.
std::vector<SgbmPostProcessing> following_steps(const SgbmPostProcessing& variant) {
  struct Speckles {
    int opencv_px;
    int opencv_range_px;
    int ours_px;
  };
  constexpr std::array<Speckles, 6> kSpeckles = {
      {{0, 0, 0}, {0, 0, 100}, {100, 1, 0}, {100, 2, 0}, {100, 32, 0}, {200, 2, 0}}};
  std::vector<SgbmPostProcessing> all;
  for (const Speckles& speckles : kSpeckles) {
    all.push_back({variant.uniqueness_percent, variant.disp12_max_diff_px, speckles.opencv_px,
                   speckles.opencv_range_px, variant.cross_check_px, speckles.ours_px,
                   variant.fill});
  }
  return all;
}

/// One set of post-processing and what it gave.
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

/// Adds the scene to all that may follow one variant of the matcher.
void try_variant(SgbmSetting setting, const LoadedScene& scene, Execution& execution,
                 std::vector<Tried>& tried) {
  setting.post_processing = tried.front().post_processing;
  const PeerDisparities winners =
      both_disparities(*make_sgbm_matcher(setting, scene.pair), scene.pair.left_opencv,
                       scene.pair.right_opencv, scene.pair.range);
  for (Tried& one : tried) {
    PeerDisparities filtered = copy(winners);
    filter_opencv_speckles(one.post_processing, scene.pair.range, filtered);
    const DisparityMaps maps = refine_peer_maps(one.post_processing, scene.pair,
                                                to_maps(filtered, scene.pair.range), execution);
    one.of_scenes.push_back(bad_pixels(maps.left, scene));
  }
}

/// Best first.
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
  std::vector<std::vector<Tried>> of_variants;
  for (const SgbmPostProcessing& variant : matcher_variants()) {
    of_variants.emplace_back();
    for (const SgbmPostProcessing& post_processing : following_steps(variant)) {
      of_variants.back().push_back({post_processing, {}});
    }
  }
  std::vector<std::vector<std::vector<Tried>>> tried(settings.size(), of_variants);
  cv::setNumThreads(1);  // variants run side by side instead
  for (const TrueScene* scene : scenes) {
    const LoadedScene loaded = load_scene(*scene, data);
    fmt::print(stderr, "{}\n", scene->name);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      execution.executor().parallel_for(static_cast<int>(of_variants.size()), [&](int variant) {
        try_variant(settings[i], loaded, execution, tried[i][static_cast<std::size_t>(variant)]);
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
    for (const std::vector<Tried>& of_variant : tried[i]) {
      all.insert(all.end(), of_variant.begin(), of_variant.end());
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
