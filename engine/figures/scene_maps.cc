#include "engine/figures/scene_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/image/eight_bit.h"
#include "engine/image/transposed.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

std::optional<DisparityScores> scores_of(const FigureImages& images,
                                         ImageView<const float> left_disparity) {
  if (!images.left_truth) {
    return std::nullopt;
  }
  DisparityEvaluationOptions options;
  if (images.left_visible) {
    options.mask = images.left_visible->view();
  }
  return evaluate_disparity(left_disparity, images.left_truth->view(), options);
}

}  // namespace

MatchOptions scene_options(const FigureSettings& settings, const std::string& method,
                           int iterations, DisparityRange disparities, bool dense) {
  MatchOptions options = compared_options(compared_method(method), BookPattern::kGrass, iterations,
                                          settings.parameters);
  options.disparities = disparities;
  if (dense && !options.preset) {
    constexpr double kTolerance = 3.0 / 45;
    options.raw = false;
    options.refinement.edge_snapping_px = 4;
    options.refinement.cross_check_px = std::max(1.0, kTolerance * disparities.count());
  }
  return options;
}

DisparityMaps scene_maps(const FigureImages& images, const MatchOptions& options,
                         Execution& execution) {
  DisparityMaps maps;
  StereoMatcher(options, execution).match(images.left, images.right, {.confidence = true}, maps);
  return maps;
}

SheetPicture photograph_picture(const FigureImages& images, std::string title,
                                const Photograph& photograph) {
  return {std::move(title),
          images.is_transposed ? eight_bit(transposed(photograph)) : eight_bit(photograph)};
}

FigureContent show_pair(BookImages which, const std::string& title,
                        const std::array<const char*, 2>& names, double width,
                        const FigureRun& run) {
  const auto images = images_of(which, run);
  FigureContent content{.images = images->description};
  std::vector<SheetPicture> pictures;
  pictures.push_back(photograph_picture(*images, names[0], images->left));
  pictures.push_back(photograph_picture(*images, names[1], images->right));
  content.pictures.push_back({"", draw_picture_sheet(title, pictures, 2, width)});
  return content;
}

SheetPicture map_picture(const FigureImages& images, std::string title,
                         ImageView<const float> disparity) {
  const auto min = static_cast<float>(images.disparities.min);
  const auto max = static_cast<float>(std::max(images.disparities.max, images.disparities.min + 1));
  constexpr Colour kBlack{0, 0, 0};
  if (images.is_transposed) {
    const DisparityMap upright = transposed(disparity);
    return {std::move(title), grey_picture(upright.view(), min, max, kBlack)};
  }
  return {std::move(title), grey_picture(disparity, min, max, kBlack)};
}

std::vector<std::string> score_fields(const FigureImages& images,
                                      ImageView<const float> left_disparity) {
  const auto scores = scores_of(images, left_disparity);
  if (!scores) {
    return std::vector<std::string>(4);
  }
  return {fmt::format("{:.3f}", scores->bad_0_5_percent),
          fmt::format("{:.3f}", scores->bad_1_percent),
          fmt::format("{:.3f}", scores->bad_2_percent), fmt::format("{:.4f}", scores->rms_px)};
}

}  // namespace vantage
