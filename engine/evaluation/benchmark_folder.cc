#include "engine/evaluation/benchmark_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

struct KittiFolders {
  BenchmarkLayout layout;
  const char* all;
  const char* noc;
  const char* images;
};
constexpr KittiFolders kKitti[] = {
    {BenchmarkLayout::kKitti2015, "disp_occ_0", "disp_noc_0", "image_2"},
    {BenchmarkLayout::kKitti2012, "disp_occ", "disp_noc", "image_0"},
    {BenchmarkLayout::kKitti2012, "disp_occ", "disp_noc", "colored_0"}};
constexpr std::string_view kKittiFirst = "_10";  ///< the frame of a scene that is evaluated

constexpr const char* kSceneTruths[] = {"disp0GT.pfm", "disp0.pfm", "truedisp.row3.col3.pgm",
                                        "disp2.pgm",   "disp2.png", "disp1.png",
                                        "disp1.pgm",   "disp3.pgm"};
constexpr const char* kSceneImages[] = {"im0.png", "im2.png", "im2.ppm", "view1.png"};
constexpr const char* kVisibleMasks[] = {"mask0nocc.png", "nonocc.png", "mask_nonocc2.png"};
constexpr const char* kEdgeMasks[] = {"disc.png", "mask_disc2.png"};

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

/// Names in a folder, sorted; none where there is no folder.
std::vector<std::string> entries_of(const fs::path& folder, bool folders) {
  std::vector<std::string> names;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (folders ? entry.is_directory() : entry.is_regular_file()) {
        names.push_back(entry.path().filename().string());
      }
    }
  }
  std::ranges::sort(names);
  return names;
}

bool is_map_name(const std::string& name) {
  constexpr std::string_view kExtensions[] = {".pfm", ".png", ".tiff", ".tif",
                                              ".exr", ".npy", ".pgm"};
  return std::ranges::count(kExtensions, lower_case_extension(name)) > 0;
}

std::string stem_of(const std::string& name) { return fs::path(name).stem().string(); }

/// The first of `names` that is in the folder; empty: none is.
template <std::size_t kCount>
fs::path first_in(const fs::path& folder, const char* const (&names)[kCount]) {
  const auto* const found =
      std::ranges::find_if(names, [&](const char* name) { return fs::exists(folder / name); });
  return found == std::end(names) ? fs::path() : folder / *found;
}

std::vector<BenchmarkScene> kitti_scenes(const fs::path& folder, const KittiFolders& kitti) {
  std::vector<BenchmarkScene> scenes;
  for (const char* subfolder : {kitti.all, kitti.noc, kitti.images}) {
    for (const std::string& name : entries_of(folder / subfolder, false)) {
      const std::string stem = stem_of(name);
      if (!stem.ends_with(kKittiFirst)) {
        continue;
      }
      BenchmarkScene scene{.name = stem, .regions = {}};
      const fs::path objects = folder / "obj_map" / name;
      for (const auto& [region, truth] : {std::pair("all", kitti.all), {"noc", kitti.noc}}) {
        if (fs::exists(folder / truth / name)) {
          scene.regions.push_back({region, folder / truth / name});
        }
      }
      if (kitti.layout == BenchmarkLayout::kKitti2015 && !scene.regions.empty() &&
          fs::exists(objects)) {
        const fs::path truth = scene.regions[0].truth;
        scene.regions.push_back({"bg", truth, objects, 0, 0});
        scene.regions.push_back({"fg", truth, objects, 1, 255});
      }
      scenes.push_back(std::move(scene));
    }
    if (!scenes.empty()) {
      break;
    }
  }
  return scenes;
}

/// ETH3D's names of pairs: a place, a number, l or s.
bool is_eth3d_name(const std::string& name) {
  const std::size_t size = name.size();
  return size > 3 && (name.back() == 'l' || name.back() == 's') &&
         std::isdigit(static_cast<unsigned char>(name[size - 2])) != 0 && name[size - 3] == '_';
}

std::vector<BenchmarkScene> folder_scenes(const fs::path& folder) {
  std::vector<BenchmarkScene> scenes;
  for (const std::string& name : entries_of(folder, true)) {
    const fs::path place = folder / name;
    const fs::path truth = first_in(place, kSceneTruths);
    if (truth.empty() && first_in(place, kSceneImages).empty()) {
      continue;
    }
    BenchmarkScene scene{.name = name, .regions = {}};
    if (!truth.empty()) {
      scene.regions.push_back({"all", truth});
      for (const auto& [region, mask] : {std::pair("noc", first_in(place, kVisibleMasks)),
                                         {"disc", first_in(place, kEdgeMasks)}}) {
        if (!mask.empty()) {
          scene.regions.push_back({region, truth, mask});
        }
      }
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
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

/// 255 where the region is, and whether the truth is known anywhere there.
std::optional<Mask> region_mask(const BenchmarkRegion& region, ImageView<const float> truth,
                                int border_px) {
  Mask mask(truth.width(), truth.height());
  mask.fill(255);
  if (!region.mask.empty()) {
    const Image<std::uint8_t> stored = eight_bit(read_photograph(region.mask));
    if (stored.width() != truth.width() || stored.height() != truth.height()) {
      throw Error(fmt::format("{} is {}x{}, expected the truth's {}x{}", region.mask.string(),
                              stored.width(), stored.height(), truth.width(), truth.height()));
    }
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        const int value = stored.at(x, y, 0);
        mask.at(x, y) = value >= region.mask_min && value <= region.mask_max ? 255 : 0;
      }
    }
  }
  for (int y = border_px; y < truth.height() - border_px; ++y) {
    for (int x = border_px; x < truth.width() - border_px; ++x) {
      if (mask.at(x, y) == 255 && std::isfinite(truth.at(x, y))) {
        return mask;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

BenchmarkFolder read_benchmark_folder(const fs::path& folder) {
  for (const fs::path& root : {folder, folder / "training"}) {
    for (const KittiFolders& kitti : kKitti) {
      if (std::vector<BenchmarkScene> scenes = kitti_scenes(root, kitti); !scenes.empty()) {
        return {kitti.layout, std::move(scenes)};
      }
    }
  }
  if (std::vector<BenchmarkScene> scenes = folder_scenes(folder); !scenes.empty()) {
    const bool is_eth3d = std::ranges::all_of(scenes, is_eth3d_name, &BenchmarkScene::name);
    return {is_eth3d ? BenchmarkLayout::kEth3d : BenchmarkLayout::kMiddlebury, std::move(scenes)};
  }
  BenchmarkFolder files;
  for (const std::string& name : entries_of(folder, false)) {
    if (is_map_name(name)) {
      files.scenes.push_back({stem_of(name), {{"all", folder / name}}});
    }
  }
  if (files.scenes.empty()) {
    throw Error(
        fmt::format("{}: has no true disparities, expected KITTI's disp_occ_0 or disp_occ, "
                    "folders of scenes as Middlebury and ETH3D have, or maps",
                    folder.string()));
  }
  return files;
}

std::optional<fs::path> find_benchmark_map(const fs::path& maps, const std::string& scene) {
  const std::string short_name =
      scene.ends_with(kKittiFirst) ? scene.substr(0, scene.size() - kKittiFirst.size()) : scene;
  std::vector<fs::path> fits[3];  // the best first
  const auto add = [&](const fs::path& folder, const auto& rank_of) {
    for (const std::string& name : entries_of(folder, false)) {
      const std::string stem = stem_of(name);
      if (const int rank = is_map_name(name) ? rank_of(stem) : -1; rank >= 0) {
        fits[rank].push_back(folder / name);
      }
    }
  };
  for (const char* subfolder : {"", "disp_0", "disparity", "low_res_two_view"}) {
    add(maps / subfolder, [&](const std::string& stem) {
      const bool begins = stem.starts_with(scene) && stem.size() > scene.size() &&
                          std::isalnum(static_cast<unsigned char>(stem[scene.size()])) == 0;
      return stem == scene ? 0 : stem == short_name ? 1 : begins ? 2 : -1;
    });
  }
  add(maps / scene, [](const std::string& stem) {
    return stem == "disp0GT" || stem == "disp0y" ? -1 : stem.starts_with("disp0") ? 1 : 2;
  });
  for (const std::vector<fs::path>& found : fits) {
    if (found.size() > 1) {
      throw Error(fmt::format("{} and {} are both maps of {}, expected one", found[0].string(),
                              found[1].string(), scene));
    }
    if (!found.empty()) {
      return found[0];
    }
  }
  return std::nullopt;
}

std::vector<RegionScores> evaluate_scene(const BenchmarkScene& scene,
                                         ImageView<const float> disparity, double truth_scale,
                                         int ignore_border_px) {
  std::vector<RegionScores> scores;
  for (const BenchmarkRegion& region : scene.regions) {
    const DisparityMap truth = read_truth(region.truth, truth_scale);
    if (const auto mask = region_mask(region, truth.view(), ignore_border_px)) {
      try {
        scores.push_back({region.name, evaluate_disparity(disparity, truth.view(),
                                                          {.mask = mask->view(),
                                                           .ignore_border_px = ignore_border_px})});
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", region.truth.string(), error.what()));
      }
    }
  }
  return scores;
}

}  // namespace vantage
