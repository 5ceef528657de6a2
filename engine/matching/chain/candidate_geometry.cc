#include "engine/matching/chain/candidate_geometry.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"

namespace vantage {

kernels::CandidateGeometry candidate_geometry(const ResolvedMatchOptions& options, Side reference,
                                              int width, int height) {
  // Whole windows need room: with border `valid` they shorten the largest shift that can match.
  const MethodParameters& parameters = options.parameters;
  const bool has_whole_windows =
      aggregation_of(parameters).has_windows && parameters.border == Border::kValid;
  const int margin = has_whole_windows ? parameters.window_px - 1 : 0;
  const int max_shift = width - 1 - margin;
  const int min = std::max(options.disparities.min, -max_shift);
  const int max = std::min(options.disparities.max, max_shift);
  if (max < min || height <= margin) {
    throw Error(fmt::format(
        "no pixel has a candidate: disparities {}:{}{} on images of {}x{}, expected a range that "
        "reaches into {}:{}",
        options.disparities.min, options.disparities.max,
        margin > 0 ? fmt::format(" with whole {0}x{0} windows (border valid)", parameters.window_px)
                   : "",
        width, height, -std::max(0, max_shift), std::max(0, max_shift)));
  }
  const int steps = steps_per_px(parameters);
  return {width, steps * min, steps * (max - min) + 1, direction_of(reference), steps};
}

std::optional<DisplacementGrid> displacement_grid(const ResolvedMatchOptions& options,
                                                  Side reference, int width, int height) {
  if (!options.disparities_y) {
    return std::nullopt;
  }
  const MethodParameters& parameters = options.parameters;
  const int margin = parameters.border == Border::kValid ? parameters.window_px - 1 : 0;
  const int max_shift = height - 1 - margin;
  const int min = std::max(options.disparities_y->min, -max_shift);
  const int max = std::min(options.disparities_y->max, max_shift);
  const kernels::CandidateGeometry along_rows =
      candidate_geometry(options, reference, width, height);
  if (max < min) {
    throw Error(fmt::format(
        "no pixel has a candidate: disparities-y {}:{} on images of {}x{}, expected a range that "
        "reaches into {}:{}",
        options.disparities_y->min, options.disparities_y->max, width, height,
        -std::max(0, max_shift), std::max(0, max_shift)));
  }
  return DisplacementGrid{along_rows, min, max - min + 1, height};
}

}  // namespace vantage
