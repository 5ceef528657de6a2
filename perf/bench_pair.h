#pragma once

#include "engine/execution.h"
#include "engine/generation/layered_scene.h"
#include "engine/image/photograph.h"
#include "perf/peers.h"

namespace vantage::perf {

/// A rendered pair with textured surfaces over most of a disparity range, in colour and grey.
struct Pair {
  Photograph left;
  Photograph right;
  Photograph left_grey;
  Photograph right_grey;
};

inline Pair make_pair(int width, int height, int disparities) {
  LayeredSceneOptions options;
  options.width_px = width;
  options.height_px = height;
  options.samples_per_side = 2;
  options.near_disparity_px = disparities * 0.9;
  options.far_disparity_px = disparities * 0.1;
  Execution execution({});
  const LayeredScene scene(options, execution);
  Pair pair{scene.render({0, 0}, 0).image, scene.render({1, 0}, 0).image, {}, {}};
  pair.left_grey = to_grey(pair.left);
  pair.right_grey = to_grey(pair.right);
  return pair;
}

}  // namespace vantage::perf
