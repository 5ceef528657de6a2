#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage::perf {

/// A pair with truth for the left map.
struct TrueScene {
  std::string name;
  std::string group;
  /// true: parameters are chosen on scenes of this kind; false: for evaluation only.
  bool is_tuning;
  std::string folder;  ///< relative to the folder of the scenes
  std::string left, right, truth;
  double scale;            ///< factor of integers in the truth's file
  DisparityRange range;    ///< rounded, covers the truth
  bool is_fractional;      ///< the truth resolves much less than a tenth of a pixel
  float truth_factor = 1;  ///< baselines of the pair per baseline of the truth
};

const std::vector<TrueScene>& true_scenes();

/// Input of the matchers.
struct ScenePair {
  Photograph left;  ///< grey or RGB, 8 bits
  Photograph right;
  cv::Mat left_opencv;  ///< the same, grey or BGR
  cv::Mat right_opencv;
  DisparityRange range;
};

/// A scene in memory, with masks of the pixels that are evaluated separately.
struct LoadedScene {
  ScenePair pair;
  DisparityMap truth;       ///< NaN where unknown
  Mask visible;             ///< 255: seen in both images
  Mask near_discontinuity;  ///< subset of visible: within 4 px of a jump of the true disparity by
                            ///< over 2 px
};

/// Removes the alpha channel. Throws std::bad_variant_access unless the images have 8 bits.
ScenePair make_scene_pair(Photograph left, Photograph right, DisparityRange range);

/// Who matches grey images, of 8 bits, instead of colour images.
enum class GreyImages { kNobody, kPeers, kAll };
void make_grey(ScenePair& pair, GreyImages grey);

/// Throws Error if a file is missing or invalid.
LoadedScene load_scene(const TrueScene& scene, const std::filesystem::path& data);

}  // namespace vantage::perf
