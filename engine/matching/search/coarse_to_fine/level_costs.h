#pragma once

#include <vector>

#include "engine/execution.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/matching/search/coarse_to_fine/searched_image.h"
#include "engine/matching/search/coarse_to_fine/searched_parts.h"
#include "scheduler/range.h"

namespace vantage {

/// Makes the costs of coarse levels from those of the image, level by level: energies −ln p0 are
/// summed over blocks of 2×2 columns for Bayesian diffusion (times level_weight) and averaged for
/// other methods. Costs of levels with bands are made again for each band that is searched. All
/// references must outlive the object.
class LevelCosts {
 public:
  /// `size`: as MatchChain reads the image's height from it. `run` makes the costs of level 1.
  LevelCosts(const SearchedImage& image, const MapOutputs& size, CoarseLevels& levels,
             Execution& execution, const RunChain& run)
      : image_(image), size_(size), levels_(levels), execution_(execution), run_(run) {}

  /// Makes the costs of all levels without bands; there is a coarse level. parts: the only ones to
  /// make; null: all.
  void make_levels(const SearchedParts* parts);
  /// Runs the chain at `place`, a level with bands, band by band. `geometry`: of the level.
  void search_in_bands(const ChainLevel& place, const kernels::CandidateGeometry& geometry);

 private:
  void make_level_1(const SearchedParts* parts);
  void make_rows(int level, scheduler::Range rows);
  void reduce_rows(int level, scheduler::Range rows);
  void reduce_regions(int level, const std::vector<scheduler::Region>& regions);
  void reduce_energy_row(int level, int y, scheduler::Range columns, std::uint16_t* work);

  const SearchedImage& image_;
  const MapOutputs& size_;
  CoarseLevels& levels_;
  Execution& execution_;
  const RunChain& run_;
};

}  // namespace vantage
