#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/scene_maps.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

/// The left map by multiple-baseline stereo from all images (6.6).
DisparityMap map_of_several(const FigureImages& images, const FigureSettings& settings,
                            const std::string& method, int iterations, DisparityRange disparities,
                            Execution& execution) {
  MatchOptions options = scene_options(settings, method, iterations, disparities, false);
  std::vector<OtherView> others = {{&images.right, images.baselines.front()}};
  for (std::size_t i = 0; i < images.more.size(); ++i) {
    others.push_back({&images.more[i], images.baselines[i + 1]});
  }
  DisparityMaps maps;
  StereoMatcher(options, execution)
      .match_several(images.left, others, {.right = false, .unmatched = false}, maps);
  return std::move(maps.left.disparity_px);
}

/// 50 iterations with the parameters that the captions print.
FigureSettings several_images_settings(BookImages images) {
  FigureSettings settings{
      .size_px = default_width(images), .iterations = {50}, .methods = {"bayes"}, .seed = 1};
  settings.parameters.sigma_prior = 0.4;
  settings.parameters.epsilon_prior = 0.01;
  settings.parameters.sigma_measurement = 5;
  settings.parameters.epsilon_measurement = 0.1;
  return settings;
}

FigureContent make_several(BookImages which, const FigureRun& run) {
  constexpr double kPictureWidth = 300;
  const auto images = images_of(which, run);
  FigureContent content;
  content.images = fmt::format("{}; {} images", images->description, images->more.size() + 2);
  FigureTable table{
      "", {"method", "iterations", "bad_0_5_percent", "bad_1_percent", "bad_2_percent", "rms_px"}};
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(
      *images, images->is_transposed ? "upper image" : "left image", images->left));
  pictures.push_back(photograph_picture(
      *images, images->is_transposed ? "lower image" : "right image", images->right));
  for (const std::string& method : run.settings.methods) {
    for (const int iterations : run.settings.iterations) {
      const DisparityMap map = map_of_several(*images, run.settings, method, iterations,
                                              images->disparities, run.execution);
      pictures.push_back(
          map_picture(*images, fmt::format("{}, n = {}", method, iterations), map.view()));
      std::vector<std::string> row = {method, fmt::format("{}", iterations)};
      for (std::string& field : score_fields(*images, map.view())) {
        row.push_back(std::move(field));
      }
      table.rows.push_back(std::move(row));
    }
  }
  if (images->left_truth) {
    pictures.push_back(map_picture(*images, "truth", images->left_truth->view()));
  }
  content.pictures.push_back({"", draw_picture_sheet("Multiple-baseline stereo (lighter: nearer)",
                                                     pictures, 2, kPictureWidth)});
  content.tables.push_back(std::move(table));
  return content;
}

}  // namespace

std::vector<BookFigure> several_images_figures() {
  return {
      {.key = "6.18",
       .section = "6.6",
       .title = "tree by the probabilistic model from five images",
       .book = "Disparities after 50 iterations with sigma_P = 0.4, epsilon_P = 0.01, sigma_M = "
               "5 and epsilon_M = 0.1; 256x233 pixels, 16 disparities.",
       .defaults = several_images_settings(BookImages::kTree),
       .images = BookImages::kTree,
       .make = [](const FigureRun& run) { return make_several(BookImages::kTree, run); }},
      {.key = "6.19",
       .section = "6.6",
       .title = "town by the probabilistic model from five images",
       .book = "As Fig. 6.18 from cameras above each other; 240x256 pixels, 9 disparities.",
       .defaults = several_images_settings(BookImages::kTown),
       .images = BookImages::kTown,
       .make = [](const FigureRun& run) { return make_several(BookImages::kTown, run); }}};
}

}  // namespace vantage
