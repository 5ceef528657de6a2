#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/image/image.h"

namespace vantage {

/// How a data set with true disparities lies in its folders.
enum class BenchmarkLayout {
  kKitti2015,   ///< disp_occ_0 and disp_noc_0, obj_map; a test set: image_2
  kKitti2012,   ///< disp_occ and disp_noc; a test set: image_0 or colored_0
  kMiddlebury,  ///< folders of scenes: disp0GT.pfm, disp2.png …, masks; a test set: im0.png
  kEth3d,       ///< the same, scenes named …_1l, …_2s
  kFiles        ///< a folder of maps
};

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
};

struct BenchmarkFolder {
  BenchmarkLayout layout = BenchmarkLayout::kFiles;
  std::vector<BenchmarkScene> scenes;  ///< in the order of their names, at least one
};

struct RegionScores {
  std::string region;
  DisparityScores scores;
};

/// Recognises the layout of a folder by its subfolders and files. Throws Error where there is none.
BenchmarkFolder read_benchmark_folder(const std::filesystem::path& folder);

/// The map of a scene in the folder `maps`, or in its `disp_0`, `disparity`, `low_res_two_view` or
/// a subfolder of the scene's name: the file of the scene's name, in KITTI also without "_10", or
/// of a name that begins so before another mark. In the scene's subfolder: disp0…, else its only
/// map. Empty: there is none. Throws Error where several fit equally.
std::optional<std::filesystem::path> find_benchmark_map(const std::filesystem::path& maps,
                                                        const std::string& scene);

/// Errors of a map in each region that has pixels. Integers of the truth are divided by
/// `truth_scale`; 0: 256 for 16-bit PNG, what the Middlebury sets of 2001 to 2006 state for files
/// of their names and sizes. Throws Error naming the file that does not fit.
std::vector<RegionScores> evaluate_scene(const BenchmarkScene& scene,
                                         ImageView<const float> disparity, double truth_scale,
                                         int ignore_border_px);

}  // namespace vantage
