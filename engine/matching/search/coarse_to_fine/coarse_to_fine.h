#pragma once

#include <cstdint>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/matching/search/coarse_to_fine/level_costs.h"
#include "engine/matching/search/coarse_to_fine/searched_image.h"
#include "engine/matching/search/coarse_to_fine/searched_parts.h"
#include "engine/matching/volume/volume_writer.h"

namespace vantage {

/// Number of aggregated cells.
struct LevelCells {
  double all_levels = 0;
  double finest_level = 0;
};

/// The map of a coarse level instead of the image's own: no finer level is computed, and of the
/// outputs only the size is used. Bayesian diffusion only.
struct CoarseMap {
  int level = 0;  ///< 1 to the coarsest level; 0: not requested
  /// Resized to the level: numbers of candidates; pixels without a partner have one, too.
  Image<std::int32_t>* winners = nullptr;
};

/// What the other image's map is checked against, beside the map: the disparities of the map, but
/// in smooth tiles of the finest level the winners of level 1, each repeated over its pixels. Only
/// if LevelPlan::has_check_map. Does not depend on whether the map is computed.
struct CheckMap {
  ImageView<float> disparity_px = {};  ///< image-sized; empty: not requested
  /// Only the check map is needed. It may then be the map itself, whose smooth tiles are not
  /// computed.
  bool is_only = false;
};

/// What the search of one map makes.
struct WantedWinners {
  MapOutputs outputs;  ///< of the image's size
  CoarseMap coarse = {};
  CheckMap check = {};
  /// The only parts to compute, without volumes; null: all. Levels, winners and outputs must then
  /// be those of the last call.
  const SearchedParts* parts = nullptr;
};

/// Computes one map coarse to fine (6.7), or at full size if the images have one level. Costs are
/// reduced level by level (LevelCosts). Then the levels are aggregated, coarsest first, each
/// starting from the coarser level's result: Bayesian diffusion with its probabilities (or their
/// energies) as the first state and its own likelihoods, the membrane with its energies and the
/// pull of its own costs, all others with the mean of their own costs and its energies. Number and
/// unit of disparities are the same on all levels. The finest level's costs are computed from the
/// images twice and never stored. Iterations and σP depend on the level (at_level).
///
/// `run` is called with one chain after the other: with levels, the first reduces the image's costs
/// (or a band of them, LevelBands) unless stored ones are used (ChainInput::sharing); the last,
/// without windows, selects winners into the outputs.
///
/// With parameters.candidate_blocks > 0 the finest `pruned_levels` levels (never the coarsest)
/// process only a few candidate blocks per tile (CandidateBlocks), near the winners of the next
/// coarser level. Costs are still reduced from all candidates. With parameters.window_levels the
/// finest one of several is searched in windows instead (§3.13).
///
/// `volumes` take the cells of their levels; costs of a level are computed once more for them.
class CoarseToFine {
 public:
  /// All references must outlive the object.
  CoarseToFine(const SearchedImage& image, const WantedWinners& wanted, CoarseLevels& levels,
               Execution& execution, const RunChain& run)
      : image_(image),
        wanted_(wanted),
        levels_(levels),
        execution_(execution),
        run_(run),
        costs_(image, wanted.outputs, levels, execution, run) {}

  LevelCells search(const std::vector<VolumeWriter>& volumes = {});

 private:
  [[nodiscard]] LevelPlan plan(bool has_volumes) const;
  [[nodiscard]] kernels::CandidateGeometry geometry_of(int level) const;
  [[nodiscard]] bool has_check_map() const { return !wanted_.check.disparity_px.empty(); }
  void write_costs(const std::vector<VolumeWriter>& volumes);
  [[nodiscard]] ChainLevel place_of(int level);
  void search_level(int level, const VolumeWriter* volume);
  void search_windows_of_image(const VolumeWriter* volume);
  void make_check_map(const TileMask& smooth, ImageView<const std::int32_t> winners);
  void count(double finest_cells);

  const SearchedImage& image_;
  const WantedWinners& wanted_;
  CoarseLevels& levels_;
  Execution& execution_;
  const RunChain& run_;
  LevelCosts costs_;
  LevelCells cells_;
  TileMask smooth_;  ///< of the image, for a check map if it is searched in windows
};

}  // namespace vantage
