#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/disparity_maps.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/matching/search/coarse_to_fine/searched_parts.h"
#include "engine/matching/search/map_search.h"
#include "engine/matching/windows/coarse_beliefs.h"
#include "scheduler/range.h"

namespace vantage {

/// Working memory of a ReducedSearch, reused without reallocation.
struct ReducedMemory {
  DeferredMatch::Images images;
  std::vector<std::array<CostImage, 2>> costs;  ///< [reductions][side]
  EdgeWeightLevels search_edges;
  EdgeWeightLevels window_edges;
  CoarseLevels levels;
  Image<std::int32_t> winners;  ///< of the search of all candidates
  std::array<WindowState, 2> states;
  DisparityMap coarse_px;  ///< of levels of windows but the last
  DisparityMaps halves;    ///< maps at half size

  void add_use(MemoryUse& use) const;
};

/// Finds the winners of one map at half size, from prepared images: a coarse-to-fine search of all
/// candidates in the smallest images, down to half of their size, then levels of windows.
class ReducedMap {
 public:
  /// range: of the images, without disparities that no pixel can have. levels: those of the last
  /// call for this side, if there are `tiles`: the only ones to write; null: all. All must outlive
  /// the object.
  ReducedMap(SearchJob& job, Side side, DisparityRange range, ReducedMemory& memory,
             CoarseLevels& levels, const TileMask* tiles);

  /// `half`: resized. sharing: where costs can be shared.
  void compute(CostSharing sharing, bool wants_confidence, MatchedMap& half);

 private:
  void search_all_candidates(CostSharing sharing);
  void search_windows_at(int reductions, const CoarseBeliefs& coarse, MatchedMap& half);
  [[nodiscard]] const EdgeWeights* edges_at(int reductions);
  void count(int reductions);
  [[nodiscard]] const Photograph& image_at(int reductions) const {
    return memory_.images[own_].reduced(reductions);
  }
  [[nodiscard]] const std::vector<scheduler::Region>* regions_at(int reductions) const;

  SearchJob& job_;
  Side side_;
  std::size_t own_;  ///< index of the map's image
  DisparityRange range_;
  ReducedMemory& memory_;
  CoarseLevels& levels_;
  const TileMask* tiles_;
  const ResolvedMatchOptions search_;  ///< of the search of all candidates
  std::span<const EdgeWeights> edges_;
  // What is computed of each level to write the tiles.
  SearchedParts parts_;
  std::vector<scheduler::Region> coarse_windows_;  ///< of the level of windows before the map's
  std::vector<scheduler::Region> map_;
};

}  // namespace vantage
