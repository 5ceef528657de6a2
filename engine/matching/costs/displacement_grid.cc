#include "engine/matching/costs/displacement_grid.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/matching/costs/candidate_geometry.h"

namespace vantage {

std::optional<DisplacementGrid> displacement_grid(const ResolvedMatchOptions& options,
                                                  Side reference, int width, int height) {
  if (!options.disparities_y) {
    return std::nullopt;
  }
  const MethodParameters& parameters = options.parameters;
  const int margin = parameters.border == Border::kValid ? parameters.window_px - 1 : 0;
  const int most_shift = height - 1 - margin;
  const int least = std::max(options.disparities_y->min, -most_shift);
  const int most = std::min(options.disparities_y->max, most_shift);
  const kernels::CandidateGeometry along_rows =
      candidate_geometry(options, reference, width, height);
  if (most < least) {
    throw Error(fmt::format(
        "no pixel has a candidate: disparities-y {}:{} on images of {}x{}, expected a range that "
        "reaches into {}:{}",
        options.disparities_y->min, options.disparities_y->max, width, height,
        -std::max(0, most_shift), std::max(0, most_shift)));
  }
  return DisplacementGrid{along_rows, least, most - least + 1, height};
}

}  // namespace vantage
