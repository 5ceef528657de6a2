#include "engine/figures/figure_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"

namespace vantage {
namespace {

/// A generated scene in place of a pair of the book.
struct StandIn {
  BookImages images;
  std::string_view instead_of;
  int width_px;
  int height_px;
  double far_disparity_px;
  double near_disparity_px;
  DisparityRange search;
  double right_y = 0;  ///< vertical position of the right camera, in baselines
  double right_gain = 1;
  double right_offset = 0;
  double noise_sigma = 0;
  int more_cameras = 0;
  bool is_vertical = false;
  int right_frame = 0;  ///< time of the right image
};

constexpr std::array kStandIns = {
    StandIn{BookImages::kKids, "the pair kids (Intille and Bobick)", 350, 236, 5, 46, {4, 48}},
    StandIn{.images = BookImages::kBirch,
            .instead_of = "the pair birch (JISCT)",
            .width_px = 320,
            .height_px = 240,
            .far_disparity_px = 4,
            .near_disparity_px = 26,
            .search = {0, 30},
            .right_gain = 0.9,
            .right_offset = 8,
            .noise_sigma = 6},
    StandIn{.images = BookImages::kStreet,
            .instead_of = "the pair street (Fraunhofer IITB)",
            .width_px = 360,
            .height_px = 288,
            .far_disparity_px = 2,
            .near_disparity_px = 18,
            .search = {-3, 21},
            .right_y = 0.12,
            .right_gain = 0.75,
            .right_offset = 25},
    StandIn{.images = BookImages::kRectifiedStreet,
            .instead_of = "the rectified pair street (Fraunhofer IITB)",
            .width_px = 360,
            .height_px = 288,
            .far_disparity_px = 2,
            .near_disparity_px = 18,
            .search = {-3, 21},
            .right_gain = 0.75,
            .right_offset = 25},
    StandIn{.images = BookImages::kTree,
            .instead_of = "the tree sequence (SRI)",
            .width_px = 256,
            .height_px = 233,
            .far_disparity_px = 2,
            .near_disparity_px = 11,
            .search = {0, 15},
            .noise_sigma = 2,
            .more_cameras = 3},
    StandIn{.images = BookImages::kCat,
            .instead_of = "the sequence cat (Woodfill)",
            .width_px = 320,
            .height_px = 240,
            .far_disparity_px = 8,
            .near_disparity_px = 13,
            .search = {-4, 15},
            .right_y = 0.08,
            .noise_sigma = 2,
            .right_frame = 4},
    StandIn{.images = BookImages::kTown,
            .instead_of = "the town sequence (CMU)",
            .width_px = 240,
            .height_px = 256,
            .far_disparity_px = 1,
            .near_disparity_px = 7,
            .search = {0, 8},
            .noise_sigma = 2,
            .more_cameras = 3,
            .is_vertical = true}};

const StandIn& stand_in_of(BookImages images) {
  return *std::ranges::find(kStandIns, images, &StandIn::images);
}

int scaled(int length, double scale) {
  return std::max(1, static_cast<int>(std::lround(length * scale)));
}

Mask inverted(Mask mask) {
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      mask.at(x, y) = mask.at(x, y) == 0 ? 255 : 0;
    }
  }
  return mask;
}

FigureImages generate(const StandIn& stand_in, const FigureRun& run) {
  const double scale = static_cast<double>(run.settings.size_px.value()) / stand_in.width_px;
  LayeredSceneOptions options;
  options.width_px = scaled(stand_in.width_px, scale);
  options.height_px = scaled(stand_in.height_px, scale);
  options.far_disparity_px = stand_in.far_disparity_px * scale;
  options.near_disparity_px = stand_in.near_disparity_px * scale;
  options.right_gain = stand_in.right_gain;
  options.right_offset = stand_in.right_offset;
  options.noise_sigma = stand_in.noise_sigma;
  // Each stand-in is a scene of its own; the two streets are one.
  options.seed = run.settings.seed.value() + static_cast<std::uint64_t>(stand_in.instead_of.size());
  if (stand_in.images == BookImages::kRectifiedStreet) {
    options.seed = run.settings.seed.value() + stand_in_of(BookImages::kStreet).instead_of.size();
  }
  const auto scene = std::make_shared<const LayeredScene>(options, run.execution);

  const SceneView right_view =
      stand_in.is_vertical ? SceneView{0, 1} : SceneView{1, stand_in.right_y};
  SceneRendering left = scene->render(SceneView{}, 0);
  SceneRendering right = scene->render(right_view, stand_in.right_frame);
  FigureImages images{
      .description = fmt::format(
          "a generated scene of {}x{} pixels with disparities of {:.3g} to {:.3g}, because {} is "
          "not public; photographs can be given instead",
          options.width_px, options.height_px, *options.far_disparity_px,
          *options.near_disparity_px, stand_in.instead_of),
      .left = std::move(left.image),
      .right = std::move(right.image),
      .disparities = {static_cast<int>(std::floor(stand_in.search.min * scale)),
                      static_cast<int>(std::ceil(stand_in.search.max * scale))},
      .left_truth = std::move(left.disparity),
      .left_visible = inverted(scene->occlusion(SceneView{}, right_view, 0))};
  if (stand_in.right_frame != 0) {  // what moves has another displacement
    images.left_truth.reset();
    images.left_visible.reset();
    return images;
  }
  for (int camera = stand_in.more_cameras; camera > 0; --camera) {
    const double position = static_cast<double>(camera) / (stand_in.more_cameras + 1);
    images.baselines.push_back(position);
    images.more.push_back(scene
                              ->render(stand_in.is_vertical
                                           ? SceneView{0, position}
                                           : SceneView{position, position * stand_in.right_y},
                                       0)
                              .image);
  }
  if (stand_in.is_vertical) {
    images.is_transposed = true;
    images.left = transposed(images.left);
    images.right = transposed(images.right);
    images.left_truth = transposed(images.left_truth->view());
    images.left_visible = transposed(images.left_visible->view());
    for (Photograph& image : images.more) {
      image = transposed(image);
    }
  } else {
    images.view = [scene, stand_in](double x) {
      return std::optional(scene->render(SceneView{x, x * stand_in.right_y}, 0).image);
    };
  }
  return images;
}

}  // namespace

std::shared_ptr<const FigureImages> images_of(BookImages images, const FigureRun& run) {
  if (run.given != nullptr) {
    return {run.given, [](const FigureImages*) {}};  // the caller's
  }
  return std::make_shared<const FigureImages>(generate(stand_in_of(images), run));
}

int default_width(BookImages images) { return stand_in_of(images).width_px; }

}  // namespace vantage
