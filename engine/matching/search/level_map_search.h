#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/image/memory_use.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/search/map_search.h"

namespace vantage {

/// Working memory of a LevelMapSearch, reused without reallocation.
struct LevelMemory {
  std::vector<CostImage> images;
  EdgeWeightLevels edges;  ///< of the map being computed
  CoarseLevels levels;
  /// Check maps beside whole maps.
  std::array<DisparityMap, 2> check_px;

  void add_use(MemoryUse& use) const;
};

/// A search at the images' size, flat or over levels: what searches of pairs, of several images and
/// along epipolar lines have in common. Those prepare the input of each map's chains.
class LevelMapSearch : public MapSearch {
 public:
  [[nodiscard]] std::vector<scheduler::ChainPlan> plans(
      const MapTask& task, std::span<const ExecutionOptions> executions) override;

 protected:
  /// Both outlive the search.
  LevelMapSearch(SearchJob& job, LevelMemory& memory) : MapSearch(job), memory_(memory) {}

  /// What the chains of the map of `task` read, but for the weights of neighbours.
  [[nodiscard]] virtual const ChainInput& input_of(const MapTask& task) = 0;
  void search_levels(MapTask& task, const ChainInput& prepared);
  /// Adds the prior of the map of `side`, if there is one.
  void add_prior(Side side, ChainInput& input) const;
  [[nodiscard]] MapToRefine to_refine(const MapTask& task) const;
  /// Where maps are not refined: marks pixels without a disparity.
  void mark_all_unknown() const;
  void start_stage(std::string_view name) const { job_.clock.start(name); }

  LevelMemory& memory_;

 private:
  /// The images that a task writes: its own, or those kept for the next pair.
  struct Targets {
    MatchedMap& map;
    DisparityMap& check_px;
    CoarseLevels& levels;
  };
  [[nodiscard]] Targets targets_of(const MapTask& task, PreviousMaps::OfSide* kept);
  void resize(const MapTask& task, const Targets& targets) const;
  [[nodiscard]] WantedWinners wanted_of(MapTask& task, const Targets& targets) const;
};

}  // namespace vantage
