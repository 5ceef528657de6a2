#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/figure_images.h"
#include "engine/figures/pair_runs.h"
#include "engine/figures/scene_maps.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

constexpr double kWidePicture = 320;

/// Both components of the displacements from the later frame to the earlier one.
FigureContent make_cat_displacements(const FigureRun& run) {
  const auto images = images_of(BookImages::kCat, run);
  FigureContent content{.images = images->description};
  FigureTable table{"", {"method", "dx_px", "dy_px", "pixels"}};
  std::vector<SheetPicture> pictures;
  for (const std::string& method : run.settings.methods) {
    MatchOptions options = scene_options(run.settings, method, run.settings.iterations.front(),
                                         images->disparities, false);
    options.disparities_y = images->disparities_y;
    const DisparityMaps maps = scene_maps(*images, options, run.execution);
    pictures.push_back(map_picture(*images,
                                   method + ": horizontal component (lighter: to the left)",
                                   maps.left.disparity_px.view()));
    pictures.push_back({method + ": vertical component (lighter: upwards)",
                        grey_picture(maps.left.disparity_y_px.view(),
                                     static_cast<float>(images->disparities_y.min),
                                     static_cast<float>(images->disparities_y.max), {0, 0, 0})});
    std::map<std::pair<float, float>, int> counts;
    for (int y = 0; y < maps.left.disparity_px.height(); ++y) {
      for (int x = 0; x < maps.left.disparity_px.width(); ++x) {
        if (std::isfinite(maps.left.disparity_px.at(x, y))) {
          ++counts[{maps.left.disparity_px.at(x, y), maps.left.disparity_y_px.at(x, y)}];
        }
      }
    }
    std::pair<float, float> most;
    int most_pixels = 0;
    for (const auto& [displacement, pixels] : counts) {
      table.add(method, displacement.first, displacement.second, pixels);
      if (pixels > most_pixels) {
        most_pixels = pixels;
        most = displacement;
      }
    }
    content.comparisons.push_back(
        {method + ": motion of the background", "more than 10 pixels to the left",
         fmt::format("most pixels move by {} to the left, {} upwards", most.first, most.second)});
  }
  content.pictures.push_back({"", draw_picture_sheet("Displacements", pictures, 2, kWidePicture)});
  content.tables.push_back(std::move(table));
  return content;
}

FigureTable score_table() {
  return {
      "",
      {"map", "matched_percent", "bad_0_5_percent", "bad_1_percent", "bad_2_percent", "rms_px"}};
}

void add_map(const FigureImages& images, const std::string& name, const DisparityMap& map,
             std::vector<SheetPicture>& pictures, FigureTable& table) {
  pictures.push_back(map_picture(images, name, map.view()));
  const double known =
      percent_where(map, [](int /*x*/, int /*y*/, float d) { return !std::isnan(d); });
  std::vector<std::string> row = {name, fmt::format("{:.2f}", known)};
  std::ranges::move(score_fields(images, map.view()), std::back_inserter(row));
  table.rows.push_back(std::move(row));
}

FigureContent make_tree_disparities(const FigureRun& run) {
  const auto images = images_of(BookImages::kTree, run);
  FigureContent content{.images = images->description};
  FigureTable table = score_table();
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(*images, "left", images->left));
  if (images->left_truth) {
    pictures.push_back(map_picture(*images, "truth", images->left_truth->view()));
  }
  for (const std::string& method : run.settings.methods) {
    const DisparityMaps maps =
        scene_maps(*images,
                   scene_options(run.settings, method, run.settings.iterations.front(),
                                 images->disparities, false),
                   run.execution);
    add_map(*images, method, maps.left.disparity_px, pictures, table);
  }
  content.pictures.push_back(
      {"", draw_picture_sheet("Disparities (lighter: nearer)", pictures, 3, kWidePicture)});
  content.tables.push_back(std::move(table));
  return content;
}

FigureContent make_street_disparities(const FigureRun& run) {
  constexpr float kBookThreshold = 2;
  const auto images = images_of(BookImages::kRectifiedStreet, run);
  FigureContent content{.images = images->description};
  DisparityMaps maps =
      scene_maps(*images, scene_options(run.settings, "gradient", 0, images->disparities, false),
                 run.execution);
  DisparityMap confident = maps.left.disparity_px.copy();
  for (int y = 0; y < confident.height(); ++y) {
    for (int x = 0; x < confident.width(); ++x) {
      if (!(maps.left.confidence.at(x, y) > kBookThreshold)) {
        confident.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  FigureTable table = score_table();
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(*images, "left", images->left));
  add_map(*images, "all winners", maps.left.disparity_px, pictures, table);
  add_map(*images, "M > 2", confident, pictures, table);
  content.pictures.push_back(
      {"", draw_picture_sheet("Disparities (lighter: nearer), uncertain ones black", pictures, 3,
                              kWidePicture)});
  content.tables.push_back(std::move(table));
  return content;
}

FigureContent make_postprocessing(const FigureRun& run) {
  const auto images = images_of(BookImages::kKids, run);
  FigureContent content{.images = images->description};
  FigureTable table = score_table();
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(*images, "left", images->left));
  const MatchOptions dense = scene_options(run.settings, "gradient", 0, images->disparities, true);
  const auto add_step = [&](const std::string& name, const auto& change) {
    MatchOptions options = dense;
    change(options);
    add_map(*images, name, scene_maps(*images, options, run.execution).left.disparity_px, pictures,
            table);
  };
  add_step("winners", [](MatchOptions& options) {
    options.raw = true;
    options.refinement = {};
  });
  add_step("discontinuities moved to edges", [](MatchOptions& options) {
    options.refinement.cross_check = false;
    options.refinement.cross_check_px.reset();
    options.refinement.confidence_threshold = kNoConfidenceThreshold;
    options.refinement.fill = Fill::kNone;
  });
  add_step("partially occluded and uncertain points black",
           [](MatchOptions& options) { options.refinement.fill = Fill::kNone; });
  add_step("extrapolated at constant depth", [](MatchOptions& /*options*/) {});
  if (images->left_truth) {
    pictures.push_back(map_picture(*images, "truth", images->left_truth->view()));
  }
  content.pictures.push_back({"", draw_picture_sheet("Post-processing of the left map (lighter: "
                                                     "nearer)",
                                                     pictures, 3, kWidePicture)});
  content.tables.push_back(std::move(table));
  return content;
}

}  // namespace

std::vector<BookFigure> gradient_figures() {
  const auto settings_for = [](BookImages images) {
    return FigureSettings{.size_px = default_width(images), .seed = 1};
  };
  FigureSettings tree_maps = settings_for(BookImages::kTree);
  tree_maps.methods = {"gradient"};
  tree_maps.iterations = {10};
  FigureSettings cat_maps = tree_maps;
  cat_maps.size_px = default_width(BookImages::kCat);
  return {{.key = "5.7",
           .section = "5.5.2",
           .title = "The pair tree",
           .book = "Images 24 and 18 of a sequence: an outdoor scene with much texture.",
           .defaults = settings_for(BookImages::kTree),
           .images = BookImages::kTree,
           .make =
               [](const FigureRun& run) {
                 return show_pair(BookImages::kTree, "Pair", {"left", "right"}, kWidePicture, run);
               }},
          {.key = "5.8",
           .section = "5.5.2",
           .title = "Disparities of tree by gradient evidence",
           .book = "Winners of the evidence accumulated with a Gaussian of sigma = 2; disparities "
                   "0 to 12.",
           .defaults = tree_maps,
           .images = BookImages::kTree,
           .make = make_tree_disparities},
          {.key = "5.9",
           .section = "5.5.2",
           .title = "Disparities of street with and without uncertain matches",
           .book = "All winners of the rectified pair, and those with M > 2; disparities -3 to 21.",
           .defaults = settings_for(BookImages::kRectifiedStreet),
           .method = "gradient",
           .images = BookImages::kRectifiedStreet,
           .make = make_street_disparities},
          {.key = "5.10",
           .section = "5.5.3",
           .title = "The pair cat",
           .book = "Frames 1 and 5 of a sequence: the camera follows a cat.",
           .defaults = settings_for(BookImages::kCat),
           .images = BookImages::kCat,
           .make =
               [](const FigureRun& run) {
                 return show_pair(BookImages::kCat, "Pair", {"earlier frame", "later frame"},
                                  kWidePicture, run);
               }},
          {.key = "5.11",
           .section = "5.5.3",
           .title = "Horizontal displacements of cat",
           .book = "Horizontal components of the displacements; search of -15 to 4 by -2 to 1 "
                   "pixels from the first frame to the second, -4 to 15 by -1 to 2 in the signs "
                   "used here.",
           .defaults = cat_maps,
           .images = BookImages::kCat,
           .make = make_cat_displacements},
          {.key = "5.12",
           .section = "5.6",
           .title = "Post-processing of a disparity map",
           .book = "Right map of kids: winners, discontinuities moved to edges at most 4 pixels "
                   "away (Canny, sigma = 1, thresholds 6 and 10), points that fail the cross-check "
                   "(t = 3, disparities 4 to 48) or lack confidence, and the filled map.",
           .defaults = settings_for(BookImages::kKids),
           .method = "gradient",
           .images = BookImages::kKids,
           .make = make_postprocessing}};
}

}  // namespace vantage
