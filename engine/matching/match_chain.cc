#include "engine/matching/match_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "engine/error.h"
#include "engine/matching/stage_column_ssd.h"
#include "engine/matching/stage_window_selection.h"

namespace vantage {

kernels::CandidateGeometry candidate_geometry(const MatchOptions& options, Reference reference,
                                              int width, int height) {
  // Whole windows need room: with border `valid` they shorten the largest shift that can match.
  const MethodParameters parameters = options.resolved();
  const int margin = parameters.border == Border::kValid ? parameters.window_px - 1 : 0;
  const int most_shift = width - 1 - margin;
  const int least = std::max(options.disparities.min, -most_shift);
  const int most = std::min(options.disparities.max, most_shift);
  if (most < least || height <= margin) {
    throw Error(fmt::format(
        "no pixel has a candidate: disparities {}:{}{} on images of {}x{}, expected a range that "
        "reaches into {}:{}",
        options.disparities.min, options.disparities.max,
        margin > 0 ? fmt::format(" with whole {0}x{0} windows (border valid)", parameters.window_px)
                   : "",
        width, height, -std::max(0, most_shift), std::max(0, most_shift)));
  }
  return {width, least, most - least + 1, reference == Reference::kLeft ? -1 : 1};
}

namespace {

/// Half the bits of a candidate's index that fit below the sums of an 8-bit window without leaving
/// 31 bits, or 0. Half, because they are made room for by scaling the intensities.
int index_shift(int window_px, const kernels::CandidateGeometry& geometry) {
  constexpr double largest_square = 255.0 * 255.0;
  int shift = 0;
  while ((1 << (2 * shift)) < geometry.lanes()) {
    ++shift;
  }
  const double largest_cell =
      (window_px * window_px * largest_square + 1) * (1 << (2 * shift));
  return largest_cell < std::numeric_limits<std::int32_t>::max() ? shift : 0;
}

}  // namespace

MatchChain::MatchChain(const MatchOptions& options, const kernels::CandidateGeometry& geometry,
                       const PreparedPair& pair, ImageView<float> disparity_px) {
  const bool left = geometry.direction < 0;
  const int height = disparity_px.height();
  const MethodParameters parameters = options.resolved();
  const int radius = parameters.window_px / 2;
  int shift = 0;
  if (pair.is_8_bit) {
    shift = index_shift(parameters.window_px, geometry);
    const auto& planes = pair.grey_8;
    add(make_column_ssd_stage(left ? planes.left : planes.right,
                              left ? planes.right_mirrored : planes.left, geometry, height, radius,
                              shift));
  } else {
    const auto& planes = pair.grey_float;
    add(make_column_ssd_stage(left ? planes.left : planes.right,
                              left ? planes.right_mirrored : planes.left, geometry, height,
                              radius));
  }
  add(make_window_selection_stage(geometry, {radius, 2 * shift, parameters.border, parameters.subpixel},
                                  disparity_px));
}

void MatchChain::add(std::unique_ptr<scheduler::RowStage> stage) {
  pointers_.push_back(stage.get());
  stages_.push_back(std::move(stage));
}

}  // namespace vantage
