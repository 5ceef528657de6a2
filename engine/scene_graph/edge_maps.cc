#include "engine/scene_graph/edge_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/error.h"
#include "engine/image/transposed.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/scene_graph/rectified_edge.h"
#include "engine/scene_graph/sheared_images.h"
#include "engine/seconds_since.h"

namespace vantage {
namespace {

/// Converts pixels along x to pixels along the edge.
void scale(ImageView<float> disparity, double factor) {
  for (int y = 0; y < disparity.height(); ++y) {
    std::transform(disparity.row(y), disparity.row(y) + disparity.width(), disparity.row(y),
                   [&](float d) { return static_cast<float>(d * factor); });
  }
}

double matched_share_of(ImageView<const std::uint8_t> unmatched) {
  std::int64_t matched = 0;
  for (int y = 0; y < unmatched.height(); ++y) {
    matched += std::count(unmatched.row(y), unmatched.row(y) + unmatched.width(), 0);
  }
  return static_cast<double>(matched) /
         (static_cast<double>(unmatched.width()) * unmatched.height());
}

}  // namespace

void SceneBuildOptions::validate() const {
  match.validate();
  if (match.disparities_y) {
    throw UsageError("disparities-y is set, expected none: images of a scene are rectified");
  }
  if (neighbours < 1 || neighbours > kMaxNeighbours) {
    throw UsageError(fmt::format("neighbours is {}, expected a number from 1 to {}", neighbours,
                                 kMaxNeighbours));
  }
}

DisparityMaps EdgeMaps::match(std::array<Photograph, 2> images, BuiltEdge& built,
                              MatchReport* report) const {
  DisparityMaps maps = scene_.is_posed() ? maps_of_posed(images, built, report)
                                         : maps_on_layout(images, built, report);
  if (options_.check_rectification) {
    require_matched(built.stored.matched_share, built.stored.disparities, built.rectification);
  }
  return maps;
}

MatchOptions EdgeMaps::options_for(double scale, const Photograph& first,
                                   const Photograph& second) const {
  MatchOptions options = options_.match;
  if (options.disparities_auto) {
    options.disparities = estimate_disparity_range(first, second, execution_);
    options.disparities_auto = false;
    if (scene_.is_posed() && options.disparities.max > 0) {
      // Infinity is at 0: poses tell it.
      options.disparities.min = std::max(options.disparities.min, 0);
    }
  } else {
    const DisparityRange range = options.disparities;
    // Rounding errors of a length like 0.1 · 3 must not widen a range by one.
    const auto outward = [&](double value) { return std::ceil(value * scale - 1e-6); };
    options.disparities = {.min = static_cast<int>(-outward(-range.min)),
                           .max = static_cast<int>(outward(range.max))};
  }
  options.validate();
  return options;
}

DisparityMaps EdgeMaps::match_rows(const std::array<Photograph, 2>& images, double scale,
                                   BuiltEdge& built, MatchReport* report) const {
  const StereoMatcher matcher(options_for(scale, images[0], images[1]), execution_);
  built.stored.disparities = matcher.in_force().disparities;
  DisparityMaps maps;
  matcher.match(images[0], images[1], {}, maps, report);
  return maps;
}

std::array<Photograph, 2> EdgeMaps::photographs_of(const SceneEdge& edge) const {
  const auto photograph = [&](int vertex) {
    return scene_.read_image(images_.at(static_cast<std::size_t>(vertex)).file, vertex, execution_);
  };
  return {photograph(edge.first), photograph(edge.second)};
}

DisparityMaps EdgeMaps::maps_of_posed(const std::array<Photograph, 2>& photographs,
                                      BuiltEdge& built, MatchReport* report) const {
  const SceneEdge& edge = built.stored.edge;
  const auto camera = [&](int vertex) {
    return scene_.images[static_cast<std::size_t>(vertex)].camera.value();
  };
  const auto start = std::chrono::steady_clock::now();
  const RectifiedEdge rectified = rectify_edge(
      calibration_of(camera(edge.first), camera(edge.second), scene_.width_px, scene_.height_px),
      photographs, options_.check_rectification, execution_);
  if (options_.check_rectification) {
    built.check_seconds = seconds_since(start);
  }
  built.rectification = rectified.error;
  built.stored.corrected_degrees = rectified.corrected_degrees;
  if (rectified.error) {
    built.stored.rectification_error_px = rectified.error->systematic_px;
  }
  const double scale =
      edge.length / scene_.unit_length * rectified.pair.focal_length_px() / scene_.focal_length_px;
  const DisparityMaps found = match_rows(rectified.images, scale, built, report);
  built.stored.matched_share = {matched_share_of(found.left.unmatched.view()),
                                matched_share_of(found.right.unmatched.view())};
  if (options_.check_rectification) {
    require_checked_or_matched(built.stored.matched_share, built.rectification);
  }
  return {.left = rectified.pair.on_photograph(Side::kLeft, found.left, scene_.focal_length_px),
          .right = rectified.pair.on_photograph(Side::kRight, found.right, scene_.focal_length_px)};
}

DisparityMaps EdgeMaps::maps_on_layout(std::array<Photograph, 2>& images, BuiltEdge& built,
                                       MatchReport* report) const {
  const SceneEdge& edge = built.stored.edge;
  for (Photograph& image : images) {
    if (edge.is_vertical) {
      image = transposed(image);
    }
  }
  const bool is_oblique = edge.slope != 0;
  const int height = images[0].height();
  const Shear shear(edge.slope, images[0].width());
  for (std::size_t side = 0; side < 2 && is_oblique; ++side) {
    images[side] = sheared(images[side], shear, execution_);
  }
  if (options_.check_rectification) {
    const auto start = std::chrono::steady_clock::now();
    built.rectification = require_rectified(images[0], images[1], lines_of(edge));
    if (built.rectification) {
      built.stored.rectification_error_px = built.rectification->systematic_px;
    }
    built.check_seconds = seconds_since(start);
  }
  DisparityMaps maps = match_rows(images, edge.length_along() / scene_.unit_length, built, report);
  const std::array<DisparityMap*, 2> disparities = {&maps.left.disparity_px,
                                                    &maps.right.disparity_px};
  const std::array<Mask*, 2> masks = {&maps.left.unmatched, &maps.right.unmatched};
  for (std::size_t side = 0; side < 2; ++side) {
    DisparityMap& disparity = *disparities[side];
    Mask& unmatched = *masks[side];
    if (is_oblique) {
      disparity = unsheared_disparity(disparity.view(), shear, height, execution_);
      unmatched = unsheared_mask(unmatched.view(), shear, height);
      mark_partners_beyond_border(disparity.view(), shear, side == 0 ? -1 : 1, unmatched.view());
      scale(disparity.view(), edge.length / edge.length_along());
    }
    if (edge.is_vertical) {
      disparity = transposed(disparity.view());
      unmatched = transposed(unmatched.view());
    }
    built.stored.matched_share[side] = matched_share_of(unmatched.view());
  }
  return maps;
}

}  // namespace vantage
