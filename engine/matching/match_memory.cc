#include "engine/matching/match_memory.h"

#include <fmt/format.h>

#include <cstdint>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/reduced_matcher.h"
#include "engine/matching/search/coarse_to_fine/level_plan.h"
#include "engine/matching/selection/symmetric_energies.h"
#include "engine/rectification/epipolar_grid.h"

namespace vantage {

std::size_t matching_bytes(const ResolvedMatchOptions& options, const MatchSize& size) {
  if (size.baselines.empty() && !size.along_lines && search_reductions(options, size.image) > 0) {
    return ReducedMatcher::working_bytes(options, size.image);
  }
  const MethodParameters& parameters = options.parameters;
  const std::size_t pixels =
      static_cast<std::size_t>(size.image.columns) * static_cast<std::size_t>(size.image.rows);
  const std::size_t channels =
      parameters.colour == ColourUse::kChannels ? static_cast<std::size_t>(size.channels) : 1;
  // Levels with lower and upper bounds or gradients, of both images, and mirrored copies.
  std::size_t planes = 4 * 2;
  for (std::size_t k = 1; k < size.baselines.size(); ++k) {
    planes += 4 * static_cast<std::size_t>(sample_phases(size.baselines[k] / size.baselines.front(),
                                                         steps_per_px(parameters)));
  }
  // Maps of the nearest image of either side, to check the reference's.
  const bool has_partner_maps =
      !size.baselines.empty() && options.refinement && options.refinement->cross_check;
  const std::size_t partner_maps = has_partner_maps ? 2 * pixels * sizeof(float) : 0;
  std::size_t grids = 0;
  if (size.along_lines) {
    // Samples of the other image along and between its lines; places of the pixels.
    planes += 4 * static_cast<std::size_t>(EpipolarGrid::kPhases * EpipolarGrid::kPhases);
    grids = 2 * 16 * pixels;
  }
  constexpr std::size_t kCheckedMaps = 2;  // of coarse levels
  const int check_level = options.refinement ? options.refinement->cross_check_level : 0;
  const int candidates = candidate_count(options.disparities, parameters);
  return pixels * channels * planes * sizeof(float) + grids + partner_maps +
         (check_level > 0 ? kCheckedMaps : 0) * (pixels >> 2 * check_level) * sizeof(std::int32_t) +
         edge_weight_bytes(parameters, pixels) +
         level_plan(parameters, size.image, candidates, size.level_bytes).bytes() +
         symmetric_energy_bytes(parameters, size.image, candidates);
}

std::string memory_obstacle(const ResolvedMatchOptions& options, const MatchSize& size,
                            std::size_t machine_bytes) {
  // A pair of bytes; maps and confidences of both images, what refinement keeps.
  const std::size_t of_pixel = 2 * static_cast<std::size_t>(size.channels) + 2 + 7 * sizeof(float);
  const std::size_t pixels =
      static_cast<std::size_t>(size.image.columns) * static_cast<std::size_t>(size.image.rows);
  const std::size_t bytes = matching_bytes(options, size) + pixels * of_pixel;
  if (machine_bytes == 0 || bytes <= machine_bytes) {
    return {};
  }
  const auto gib = [](std::size_t of_bytes) { return static_cast<double>(of_bytes) / (1 << 30); };
  return fmt::format(
      "{}x{} pixels with {} disparities need about {:.1f} GiB of memory, expected no more than the "
      "{:.1f} GiB of this machine: match tiles or fewer disparities{}",
      size.image.columns, size.image.rows, options.disparities.count(), gib(bytes),
      gib(machine_bytes),
      // Which searches several images, or along lines, at full size.
      size.baselines.empty() && !size.along_lines ? ", or use the preset realtime" : "");
}

}  // namespace vantage
