#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/figure_images.h"
#include "engine/figures/scene_maps.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

constexpr double kWidePicture = 320;

FigureContent make_tree_images(const FigureRun& run) {
  const auto images = images_of(BookImages::kTree, run);
  FigureContent content{.images = images->description};
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(*images, "left", images->left));
  pictures.push_back(photograph_picture(*images, "right", images->right));
  content.pictures.push_back({"", draw_picture_sheet("Pair", pictures, 2, kWidePicture)});
  return content;
}

FigureTable score_table() {
  return {"",
          {"map", "matched_percent", "bad_0_5_percent", "bad_1_percent", "bad_2_percent", "rms_px"},
          {}};
}

/// Share of the pixels with a disparity, percent.
double known_percent(const DisparityMap& map) {
  int known = 0;
  for (int y = 0; y < map.height(); ++y) {
    known += static_cast<int>(
        std::count_if(map.row(y), map.row(y) + map.width(), [](float d) { return d == d; }));
  }
  return 100.0 * known / (map.width() * map.height());
}

void add_map(const FigureImages& images, const std::string& name, const DisparityMap& map,
             std::vector<SheetPicture>& pictures, FigureTable& table) {
  pictures.push_back(map_picture(images, name, map.view()));
  std::vector<std::string> row = {name, fmt::format("{:.2f}", known_percent(map))};
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
  return {{.key = "5.7",
           .section = "5.5.2",
           .title = "The pair tree",
           .book = "Images 24 and 18 of a sequence: an outdoor scene with much texture.",
           .defaults = settings_for(BookImages::kTree),
           .images = BookImages::kTree,
           .make = make_tree_images},
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
