#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/refinement/refinement.h"

namespace vantage::perf {

/// A photograph taken on the baseline of a pair.
struct RealView {
  std::string file;
  double x;  ///< in baselines
};

/// A pair with truth, and photographs between and beside its cameras; file names are relative to
/// the folder of the scenes.
struct ViewScene {
  std::string name, left, right;
  std::string left_truth, right_truth;  ///< the right one may be empty, see true_maps()
  double scale;                         ///< factor of the truth's files, per baseline of the pair
  /// Camera position of `left_truth`, in baselines; 0 unless it belongs to a third photograph.
  double truth_x;
  DisparityRange range;
  std::vector<RealView> views;
};

inline const std::vector<ViewScene>& view_scenes() {
  const std::vector<RealView> seven = {{"view2.png", 0.25},
                                       {"view3.png", 0.5},
                                       {"view4.png", 0.75},
                                       {"view0.png", -0.25},
                                       {"view6.png", 1.25}};
  static const std::vector<ViewScene> scenes = {
      // The truth belongs to the middle photograph and is for a quarter of the baseline.
      {"tsukuba",
       "im1.ppm",
       "im5.ppm",
       "disp3.pgm",
       "",
       4,
       0.5,
       {0, 60},
       {{"im2.ppm", 0.25}, {"im3.ppm", 0.5}, {"im4.ppm", 0.75}}},
      {"venus",
       "im2.ppm",
       "im6.ppm",
       "disp2.pgm",
       "disp6.pgm",
       8,
       0,
       {0, 31},
       {{"im3.ppm", 0.25},
        {"im4.ppm", 0.5},
        {"im5.ppm", 0.75},
        {"im0.ppm", -0.5},
        {"im1.ppm", -0.25},
        {"im7.ppm", 1.25},
        {"im8.ppm", 1.5}}},
      {"cones_half",
       "im2.png",
       "im6.png",
       "disp2.png",
       "disp6.png",
       2,
       0,
       {0, 127},
       {{"im3.png", 0.25}, {"im4.png", 0.5}, {"im5.png", 0.75}}},
      {"aloe", "view1.png", "view5.png", "disp1.png", "disp5.png", 2, 0, {0, 111}, seven},
      {"art", "view1.png", "view5.png", "disp1.png", "disp5.png", 2, 0, {0, 127}, seven},
      {"baby1", "view1.png", "view5.png", "disp1.png", "disp5.png", 2, 0, {0, 79}, seven},
      {"bowling1", "view1.png", "view5.png", "disp1.png", "disp5.png", 2, 0, {0, 127}, seven},
      {"cloth1", "view1.png", "view5.png", "disp1.png", "disp5.png", 2, 0, {0, 95}, seven},
  };
  return scenes;
}

/// A map seen from `baselines` further right: each pixel at its target, the nearest one winning.
inline DisparityMap moved(const DisparityMap& map, double baselines) {
  DisparityMap result(map.width(), map.height());
  result.fill(std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const float d = map.at(x, y);
      if (!std::isfinite(d)) {
        continue;
      }
      const int place = static_cast<int>(std::lround(x - baselines * d));
      if (place >= 0 && place < map.width() && !(result.at(place, y) >= d)) {
        result.at(place, y) = d;
      }
    }
  }
  return result;
}

/// The true maps of both images, with unknown pixels filled at constant depth.
inline DisparityMaps true_maps(const ViewScene& scene, const std::filesystem::path& folder,
                               Execution& execution) {
  DisparityMaps maps;
  maps.left.disparity_px = read_disparity(folder / scene.left_truth, scene.scale);
  if (scene.right_truth.empty()) {
    maps.right.disparity_px = moved(maps.left.disparity_px, 1 - scene.truth_x);
    maps.left.disparity_px = moved(maps.left.disparity_px, -scene.truth_x);
  } else {
    maps.right.disparity_px = read_disparity(folder / scene.right_truth, scene.scale);
  }
  Mask unknown;
  mark_unknown(maps.left.disparity_px.view(), execution, unknown);
  fill_unmatched(unknown, Side::kLeft, Fill::kConstant, execution, maps.left.disparity_px);
  mark_unknown(maps.right.disparity_px.view(), execution, unknown);
  fill_unmatched(unknown, Side::kRight, Fill::kConstant, execution, maps.right.disparity_px);
  return maps;
}

}  // namespace vantage::perf
