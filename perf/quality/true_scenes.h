#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage::perf {

/// A pair with truth of the left map.
struct TrueScene {
  std::string name;
  std::string group;
  /// Parameters are chosen on the scenes of this kind; the others judge them.
  bool is_tuning;
  std::string folder;  ///< below the folder of the scenes
  std::string left, right, truth;
  double scale;            ///< of integers in the truth's file
  DisparityRange range;    ///< a round one that covers the truth
  bool is_fractional;      ///< the truth resolves far less than a tenth of a pixel
  float truth_factor = 1;  ///< baselines of the pair per baseline of the truth
};

const std::vector<TrueScene>& true_scenes();

/// What matchers are given.
struct ScenePair {
  Photograph left;  ///< grey or RGB, 8 bits
  Photograph right;
  cv::Mat left_opencv;  ///< the same, grey or BGR
  cv::Mat right_opencv;
  DisparityRange range;
};

/// A scene in memory, and which of its pixels are judged apart.
struct LoadedScene {
  ScenePair pair;
  DisparityMap truth;       ///< NaN where unknown
  Mask visible;             ///< 255: seen in both images
  Mask near_discontinuity;  ///< of those, within 4 px of a jump of the true disparity by over 2 px
};

/// Without an alpha channel. Throws std::bad_variant_access unless they have 8 bits.
ScenePair make_scene_pair(Photograph left, Photograph right, DisparityRange range);

/// Throws Error where a file is missing or not what it should be.
LoadedScene load_scene(const TrueScene& scene, const std::filesystem::path& data);

}  // namespace vantage::perf
