#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/match_options.h"

namespace vantage::perf {

/// A real pair with dense truth of the left map; files below the folder of the scenes.
struct TrueScene {
  std::string name, left, right, truth;
  double scale;  ///< of the truth's file
  DisparityRange range;
};

inline const std::vector<TrueScene>& true_scenes() {
  static const std::vector<TrueScene> scenes = {
      {"tsukuba", "im3.ppm", "im4.ppm", "disp3.pgm", 16, {0, 15}},
      {"venus", "im2.ppm", "im6.ppm", "disp2.pgm", 8, {0, 31}},
      {"bull", "im2.ppm", "im6.ppm", "disp2.pgm", 8, {0, 31}},
      {"cones", "im2.png", "im6.png", "disp2.png", 4, {0, 63}},
      {"aloe", "view1.png", "view5.png", "disp1.png", 2, {0, 111}},
      {"art", "view1.png", "view5.png", "disp1.png", 2, {0, 127}},
      {"baby1", "view1.png", "view5.png", "disp1.png", 2, {0, 79}},
      {"bowling1", "view1.png", "view5.png", "disp1.png", 2, {0, 127}},
      {"cloth1", "view1.png", "view5.png", "disp1.png", 2, {0, 95}},
      {"motorcycle", "im0.png", "im1.png", "disp0.pfm", 1, {0, 79}},
  };
  return scenes;
}

/// A scene in memory, and which of its pixels are judged apart.
struct LoadedScene {
  std::string name;
  DisparityRange range;
  Photograph left;
  Photograph right;
  DisparityMap truth;
  Mask visible;             ///< in both images, 255
  Mask near_discontinuity;  ///< of those, within 4 px of a jump of the true disparity by over 2 px
};

/// A pixel is hidden where another one, nearer by more than a pixel, falls on its place in the
/// right image, and where that place is outside.
inline Mask visible_in_both(const DisparityMap& truth) {
  Mask visible(truth.width(), truth.height());
  std::vector<float> nearest(static_cast<std::size_t>(truth.width()));
  for (int y = 0; y < truth.height(); ++y) {
    std::fill(nearest.begin(), nearest.end(), -std::numeric_limits<float>::infinity());
    const auto place = [&](int x) {
      return static_cast<int>(std::lround(static_cast<float>(x) - truth.at(x, y)));
    };
    const auto is_inside = [&](int x) {
      return std::isfinite(truth.at(x, y)) && place(x) >= 0 && place(x) < truth.width();
    };
    for (int x = 0; x < truth.width(); ++x) {
      if (is_inside(x)) {
        float& seen = nearest[static_cast<std::size_t>(place(x))];
        seen = std::max(seen, truth.at(x, y));
      }
    }
    for (int x = 0; x < truth.width(); ++x) {
      const bool is_seen =
          is_inside(x) && truth.at(x, y) >= nearest[static_cast<std::size_t>(place(x))] - 1;
      visible.at(x, y) = is_seen ? 255 : 0;
    }
  }
  return visible;
}

inline Mask near_discontinuities(const DisparityMap& truth, const Mask& visible) {
  constexpr int reach = 4;
  constexpr float jump_px = 2;
  Mask near(truth.width(), truth.height());
  near.fill(0);
  const auto mark = [&](int centre_x, int centre_y) {
    for (int y = std::max(0, centre_y - reach); y <= std::min(truth.height() - 1, centre_y + reach);
         ++y) {
      for (int x = std::max(0, centre_x - reach);
           x <= std::min(truth.width() - 1, centre_x + reach); ++x) {
        near.at(x, y) = visible.at(x, y);
      }
    }
  };
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const float d = truth.at(x, y);
      if ((x > 0 && std::abs(d - truth.at(x - 1, y)) > jump_px) ||
          (y > 0 && std::abs(d - truth.at(x, y - 1)) > jump_px)) {
        mark(x, y);
      }
    }
  }
  return near;
}

inline LoadedScene load_scene(const TrueScene& scene, const std::filesystem::path& folder) {
  LoadedScene loaded{scene.name,
                     scene.range,
                     read_photograph(folder / scene.name / scene.left),
                     read_photograph(folder / scene.name / scene.right),
                     read_disparity(folder / scene.name / scene.truth, scene.scale),
                     {},
                     {}};
  loaded.visible = visible_in_both(loaded.truth);
  loaded.near_discontinuity = near_discontinuities(loaded.truth, loaded.visible);
  return loaded;
}

/// Percentages of bad pixels: error over 1 and 2 px, of visible pixels, all known ones, and the
/// visible ones near discontinuities.
struct SceneScores {
  std::array<double, 2> visible{};
  std::array<double, 2> all{};
  std::array<double, 2> near_discontinuity{};
};

inline SceneScores score(const DisparityMap& map, const LoadedScene& scene) {
  const auto bad = [&](const Mask* mask) {
    DisparityEvaluationOptions options;
    if (mask != nullptr) {
      options.mask = mask->view();
    }
    const DisparityScores scores = evaluate_disparity(map.view(), scene.truth.view(), options);
    return std::array{scores.bad_1_percent, scores.bad_2_percent};
  };
  return {bad(&scene.visible), bad(nullptr), bad(&scene.near_discontinuity)};
}

}  // namespace vantage::perf
