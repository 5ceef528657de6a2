#include "engine/evaluation/benchmark_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Files of the scenes of a layout: * stands for what scenes differ in.
struct SceneFiles {
  const char* layout;
  const char* region;  ///< empty: the file is of every scene, also of one without truth
  const char* file;    ///< truth, or an image
  const char* mask = "";
  int mask_min = 255;
  int mask_max = 255;
};
/// The first that a folder has say whose it is.
constexpr SceneFiles kSceneFiles[] = {
    {"KITTI 2015", "all", "disp_occ_0/*_10.png"},
    {"KITTI 2015", "noc", "disp_noc_0/*_10.png"},
    {"KITTI 2015", "bg", "disp_occ_0/*_10.png", "obj_map/*_10.png", 0, 0},
    {"KITTI 2015", "fg", "disp_occ_0/*_10.png", "obj_map/*_10.png", 1, 255},
    {"KITTI 2015", "", "image_2/*_10.png"},
    {"KITTI 2012", "all", "disp_occ/*_10.png"},
    {"KITTI 2012", "noc", "disp_noc/*_10.png"},
    {"KITTI 2012", "", "image_0/*_10.png"},
    {"KITTI 2012", "", "colored_0/*_10.png"},
    {"Middlebury or ETH3D", "all", "*/disp0GT.pfm"},
    {"Middlebury or ETH3D", "noc", "*/disp0GT.pfm", "*/mask0nocc.png"},
    {"Middlebury or ETH3D", "all", "*/disp0.pfm"},
    {"Middlebury or ETH3D", "noc", "*/disp0.pfm", "*/mask0nocc.png"},
    {"Middlebury or ETH3D", "all", "*/truedisp.row3.col3.pgm"},
    {"Middlebury or ETH3D", "noc", "*/truedisp.row3.col3.pgm", "*/nonocc.png"},
    {"Middlebury or ETH3D", "disc", "*/truedisp.row3.col3.pgm", "*/disc.png"},
    {"Middlebury or ETH3D", "all", "*/disp2.pgm"},
    {"Middlebury or ETH3D", "noc", "*/disp2.pgm", "*/nonocc.png"},
    {"Middlebury or ETH3D", "disc", "*/disp2.pgm", "*/disc.png"},
    {"Middlebury or ETH3D", "all", "*/disp2.png"},
    {"Middlebury or ETH3D", "noc", "*/disp2.png", "*/nonocc.png"},
    {"Middlebury or ETH3D", "disc", "*/disp2.png", "*/disc.png"},
    {"Middlebury or ETH3D", "all", "*/disp1.png"},
    {"Middlebury or ETH3D", "", "*/im0.png"},
    {"true maps", "all", "*"}};

/// Values per pixel of the 8-bit truths of Middlebury, by name and the least width.
struct PublishedScale {
  std::string_view stem;
  int min_width_px;
  double scale;
};
constexpr PublishedScale kPublishedScales[] = {{"truedisp.row3.col3", 0, 16},
                                               {"disp3", 0, 16},
                                               {"disp2", 1800, 1},
                                               {"disp2", 900, 2},
                                               {"disp2", 450, 4},
                                               {"disp2", 0, 8},
                                               {"disp1", 1240, 1},
                                               {"disp1", 620, 2},
                                               {"disp1", 413, 3}};

bool is_map_file(const fs::path& path) {
  constexpr std::string_view kExtensions[] = {".pfm", ".png", ".tiff", ".tif",
                                              ".exr", ".npy", ".pgm"};
  return fs::is_regular_file(path) &&
         std::ranges::count(kExtensions, lower_case_extension(path)) > 0;
}

/// Files and folders in a folder, sorted; none where there is no folder.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      entries.push_back(entry.path());
    }
  }
  std::ranges::sort(entries);
  return entries;
}

/// `pattern` with `text` in place of its star.
std::string with_star(std::string_view pattern, const std::string& text) {
  const std::size_t star = pattern.find('*');
  return std::string(pattern.substr(0, star)) + text + std::string(pattern.substr(star + 1));
}

/// What the star of a pattern stands for, for each file that is there.
std::vector<std::string> stars_of(const fs::path& folder, std::string_view pattern) {
  const std::string_view before = pattern.substr(0, pattern.find('*'));
  const std::string_view after = pattern.substr(before.size() + 1);
  std::vector<std::string> stars;
  for (const fs::path& entry : entries_of(folder / before)) {
    const std::string name = entry.filename().string();
    const bool is_folder = after.starts_with('/');
    const std::string star =
        is_folder || !name.ends_with(after) ? name : name.substr(0, name.size() - after.size());
    if (is_map_file(folder / with_star(pattern, star))) {
      stars.push_back(star);
    }
  }
  return stars;
}

DisparityMap read_truth(const fs::path& path, double scale) {
  const auto is_published = [&](const PublishedScale& one) { return one.stem == path.stem(); };
  if (scale > 0 || path.extension() == ".pfm" ||
      std::ranges::none_of(kPublishedScales, is_published)) {
    return read_disparity(path, scale);
  }
  DisparityMap truth = read_disparity(path, 1);
  const auto* const found = std::ranges::find_if(kPublishedScales, [&](const PublishedScale& one) {
    return is_published(one) && truth.width() >= one.min_width_px;
  });
  if (found == std::end(kPublishedScales)) {
    throw Error(
        fmt::format("{}: no Middlebury set has this size, expected `scale`, the values per "
                    "pixel of the truth",
                    path.string()));
  }
  for (int y = 0; y < truth.height(); ++y) {
    std::for_each(truth.row(y), truth.row(y) + truth.width(),
                  [&](float& d) { d = static_cast<float>(static_cast<double>(d) / found->scale); });
  }
  return truth;
}

/// 255 where the region is.
Mask region_mask(const BenchmarkRegion& region) {
  const Image<std::uint8_t> stored = eight_bit(read_photograph(region.mask));
  Mask mask(stored.width(), stored.height());
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const int value = stored.at(x, y, 0);
      mask.at(x, y) = value >= region.mask_min && value <= region.mask_max ? 255 : 0;
    }
  }
  return mask;
}

BenchmarkFolder recognised(const fs::path& folder) {
  BenchmarkFolder found;
  for (const SceneFiles& files : kSceneFiles) {
    if (!found.layout.empty() && found.layout != files.layout) {
      break;
    }
    for (const std::string& star : stars_of(folder, files.file)) {
      const fs::path file = folder / with_star(files.file, star);
      const fs::path mask = *files.mask == '\0' ? "" : folder / with_star(files.mask, star);
      // Scenes have a folder, or files of their name.
      const std::string name =
          *files.file == '*' && files.file[1] == '/' ? star : file.stem().string();
      auto scene = std::ranges::find(found.scenes, name, &BenchmarkScene::name);
      if (scene == found.scenes.end()) {
        found.layout = files.layout;
        found.scenes.push_back({.name = name, .regions = {}});
        scene = found.scenes.end() - 1;
      }
      const bool has_region =
          std::ranges::count(scene->regions, files.region, &BenchmarkRegion::name) > 0;
      if (*files.region != '\0' && !has_region && (mask.empty() || fs::exists(mask))) {
        scene->regions.push_back({files.region, file, mask, files.mask_min, files.mask_max});
      }
    }
  }
  if (found.scenes.empty()) {
    throw Error(
        fmt::format("{}: has no true disparities, expected KITTI's disp_occ_0 or disp_occ, "
                    "folders of scenes as Middlebury and ETH3D have, or maps",
                    folder.string()));
  }
  std::ranges::sort(found.scenes, {}, &BenchmarkScene::name);
  return found;
}

/// Empty: there is none.
fs::path find_map(const fs::path& maps, const std::string& scene) {
  const bool is_kitti = scene.ends_with("_10");
  const std::string number = is_kitti ? scene.substr(0, scene.size() - 3) : scene;
  std::vector<fs::path> found;
  for (const char* subfolder : {"", "disp_0", "disparity", "low_res_two_view"}) {
    std::ranges::copy_if(
        entries_of(maps / subfolder), std::back_inserter(found), [&](const fs::path& file) {
          return is_map_file(file) && (file.stem() == scene || file.stem() == number);
        });
  }
  std::ranges::copy_if(entries_of(maps / scene), std::back_inserter(found),
                       [](const fs::path& file) {
                         return is_map_file(file) && file.stem().string().starts_with("disp0") &&
                                file.stem() != "disp0GT";
                       });
  if (found.size() > 1) {
    throw Error(fmt::format("{} and {} are both maps of {}, expected one", found[0].string(),
                            found[1].string(), scene));
  }
  return found.empty() ? fs::path() : found[0];
}

}  // namespace

BenchmarkFolder read_benchmark_folder(const fs::path& folder, const fs::path& maps) {
  BenchmarkFolder found = recognised(folder);
  for (BenchmarkScene& scene : found.scenes) {
    scene.map = find_map(maps, scene.name);
  }
  return found;
}

std::vector<RegionScores> evaluate_scene(const BenchmarkScene& scene,
                                         ImageView<const float> disparity, double truth_scale,
                                         int ignore_border_px) {
  std::vector<RegionScores> scores;
  for (const BenchmarkRegion& region : scene.regions) {
    const DisparityMap truth = read_truth(region.truth, truth_scale);
    DisparityEvaluationOptions options{.ignore_border_px = ignore_border_px, .may_be_empty = true};
    Mask mask;
    if (!region.mask.empty()) {
      mask = region_mask(region);
      options.mask = mask.view();
    }
    const DisparityScores found = evaluate_disparity(disparity, truth.view(), options);
    if (found.evaluated_pixels > 0) {
      scores.push_back({region.name, found});
    }
  }
  return scores;
}

}  // namespace vantage
