#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/image/image.h"

namespace vantage {

/// Pixels of a scene that are evaluated: those with a truth where the mask, if there is one, has a
/// value in a range.
struct BenchmarkRegion {
  std::string name;  ///< "all", "noc" (seen by both cameras), "bg", "fg", "disc"
  std::filesystem::path truth;
  std::filesystem::path mask = {};
  int mask_min = 255;
  int mask_max = 255;
};

struct BenchmarkScene {
  std::string name;
  std::vector<BenchmarkRegion> regions;  ///< none in a test set
  std::filesystem::path map = {};        ///< to evaluate; empty: it is missing
};

/// A data set with true disparities: KITTI 2015 (disp_occ_0 and disp_noc_0, obj_map; a test set:
/// image_2), KITTI 2012 (disp_occ and disp_noc; image_0 or colored_0), folders of scenes of
/// Middlebury (disp0GT.pfm, disp2.png …, masks; im0.png) or ETH3D, or a folder of true maps.
struct BenchmarkFolder {
  std::string layout;                  ///< whose, for people
  std::vector<BenchmarkScene> scenes;  ///< in the order of their names, at least one
};

struct RegionScores {
  std::string region;
  DisparityScores scores;
};

/// Recognises the layout of a folder by its subfolders and files, and finds the map of each scene
/// in the folder `maps`, or in its `disp_0`, `disparity` or `low_res_two_view`: the file of the
/// scene's name, in KITTI also without "_10"; or disp0… in a subfolder of the scene's name. Throws
/// Error where there are no scenes, or several maps of one.
BenchmarkFolder read_benchmark_folder(const std::filesystem::path& folder,
                                      const std::filesystem::path& maps);

/// Errors of a map in each region that has pixels. Integers of the truth are divided by
/// `truth_scale`; 0: 256 for 16-bit PNG, what the Middlebury sets of 2001 to 2006 state for files
/// of their names and sizes. Throws Error for sizes that differ.
std::vector<RegionScores> evaluate_scene(const BenchmarkScene& scene,
                                         ImageView<const float> disparity, double truth_scale,
                                         int ignore_border_px);

}  // namespace vantage
