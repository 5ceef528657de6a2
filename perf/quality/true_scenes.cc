#include "perf/quality/true_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "perf/peers.h"

namespace vantage::perf {
namespace {

/// A pixel is hidden if another one, nearer by more than a pixel, falls on its position in the
/// right image, or if that position is outside. Only pixels of known disparity can hide others:
/// with sparse truth some hidden pixels count as visible.
Mask visible_in_both(const DisparityMap& truth) {
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

Mask near_discontinuities(const DisparityMap& truth, const Mask& visible) {
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

Photograph without_alpha(Photograph photograph) {
  if (photograph.channels() != 4) {
    return photograph;
  }
  const auto& rgba = std::get<Image<std::uint8_t>>(photograph.pixels);
  Image<std::uint8_t> rgb(rgba.width(), rgba.height(), 3);
  for (int y = 0; y < rgba.height(); ++y) {
    for (int x = 0; x < rgba.width(); ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        rgb.at(x, y, channel) = rgba.at(x, y, channel);
      }
    }
  }
  return {std::move(rgb)};
}

}  // namespace

const std::vector<TrueScene>& true_scenes() {
  const auto middlebury_2006 = [](const std::string& name, const std::string& group, bool is_tuning,
                                  DisparityRange range) {
    return TrueScene{name,        group,       is_tuning, name,  "view1.png",
                     "view5.png", "disp1.png", 2,         range, false};
  };
  static const std::vector<TrueScene> scenes = {
      {"tsukuba", "2001", false, "tsukuba", "im3.ppm", "im4.ppm", "disp3.pgm", 16, {0, 15}, false},
      {"venus", "2001", true, "venus", "im2.ppm", "im6.ppm", "disp2.pgm", 8, {0, 31}, false},
      {"bull", "2001", false, "bull", "im2.ppm", "im6.ppm", "disp2.pgm", 8, {0, 31}, false},
      {"cones", "2003", true, "cones", "im2.png", "im6.png", "disp2.png", 4, {0, 63}, false},
      {"cones_half",
       "2003",
       false,
       "cones_half",
       "im2.png",
       "im6.png",
       "disp2.png",
       2,
       {0, 127},
       false},
      middlebury_2006("aloe", "2005/06", true, {0, 111}),
      middlebury_2006("art", "2005/06", false, {0, 127}),
      middlebury_2006("baby1", "2005/06", false, {0, 79}),
      middlebury_2006("bowling1", "2005/06", true, {0, 127}),
      middlebury_2006("cloth1", "2005/06", false, {0, 95}),
      {"aloe_full",
       "2005/06",
       false,
       "aloe_full",
       "left.jpg",
       "right.jpg",
       "disp_left.png",
       1,
       {0, 223},
       false},
      {"motorcycle",
       "2014",
       true,
       "motorcycle",
       "im0.png",
       "im1.png",
       "disp0.pfm",
       1,
       {0, 79},
       true},
      {"motorcycle_perfect",
       "2014",
       false,
       "motorcycle_perfect",
       "im0.png",
       "im1.png",
       "disp0.pfm",
       1,
       {0, 79},
       true},
      // The right image has a different exposure.
      {"motorcycle_exposure",
       "exposure",
       true,
       "motorcycle",
       "im0.png",
       "im1E.png",
       "disp0.pfm",
       1,
       {0, 79},
       true},
      // The first one's truth covers visible pixels only.
      {"kitti2015_000045",
       "KITTI",
       true,
       "kitti2015_000045",
       "left.png",
       "right.png",
       "disp_noc_0.png",
       256,
       {0, 127},
       true},
      {"kitti2015_000046",
       "KITTI",
       false,
       "kitti2015_000046",
       "left.png",
       "right.png",
       "disp_occ_0.png",
       256,
       {0, 127},
       true},
      {"flyingthings",
       "rendered",
       false,
       "flyingthings_a0032",
       "left.png",
       "right.png",
       "disp_left.pfm",
       1,
       {0, 143},
       true},
      // The truth is for one of the four steps between these cameras.
      {"antinous",
       "rendered",
       false,
       "antinous",
       "im4.png",
       "im8.png",
       "disp4.pfm",
       1,
       {-16, 15},
       true,
       4},
  };
  return scenes;
}

ScenePair make_scene_pair(Photograph left, Photograph right, DisparityRange range) {
  ScenePair pair{without_alpha(std::move(left)), without_alpha(std::move(right)), {}, {}, range};
  pair.left_opencv = to_opencv(pair.left);
  pair.right_opencv = to_opencv(pair.right);
  return pair;
}

void make_grey(ScenePair& pair, GreyImages grey) {
  if (grey == GreyImages::kNobody || pair.left.channels() == 1) {
    return;
  }
  Photograph left = to_grey(pair.left);
  Photograph right = to_grey(pair.right);
  pair.left_opencv = to_opencv(left);
  pair.right_opencv = to_opencv(right);
  if (grey == GreyImages::kAll) {
    pair.left = std::move(left);
    pair.right = std::move(right);
  }
}

LoadedScene load_scene(const TrueScene& scene, const std::filesystem::path& data) {
  const std::filesystem::path folder = data / scene.folder;
  LoadedScene loaded{make_scene_pair(read_photograph(folder / scene.left),
                                     read_photograph(folder / scene.right), scene.range),
                     read_disparity(folder / scene.truth, scene.scale),
                     {},
                     {}};
  for (int y = 0; y < loaded.truth.height(); ++y) {
    for (int x = 0; x < loaded.truth.width(); ++x) {
      loaded.truth.at(x, y) *= scene.truth_factor;
    }
  }
  loaded.visible = visible_in_both(loaded.truth);
  loaded.near_discontinuity = near_discontinuities(loaded.truth, loaded.visible);
  return loaded;
}

}  // namespace vantage::perf
