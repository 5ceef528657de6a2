#pragma once

#include <memory>
#include <string>

#include "engine/matching/search/map_search.h"
#include "engine/matching/search/pair/pair_search.h"
#include "engine/matching/search/reduced/reduced_search.h"
#include "engine/matching/search/several/several_search.h"
#include "engine/object_pool.h"

namespace vantage {

/// Working memory of all searches, kept between calls.
struct SearchPools {
  ObjectPool<PairMemory> pair;
  ObjectPool<SeveralMemory> several;
  ObjectPool<ReducedMemory> reduced;
  ReducedSearch::ImagePool deferred_images;
  ObjectPool<RefinementWork> refinement;

  void add_memory_use(MemoryUse& use) const;
};

/// One way to find the winners of maps.
struct SearchEntry {
  SearchAbilities abilities;
  /// Whether it is the search of such images, if no entry before it is.
  bool (*serves)(const ResolvedMatchOptions& options, const MatchSize& size);
  SearchPlan (*plan)(const ResolvedMatchOptions& options, const MatchSize& size);
  /// With memory of `pools`; both outlive the search.
  std::shared_ptr<MapSearch> (*start)(SearchJob& job, SearchPools& pools);
};

/// The search of such images with these options.
const SearchEntry& search_of(const ResolvedMatchOptions& options, const MatchSize& size);
/// Throws UsageError for what the search cannot do.
void require_abilities(const SearchAbilities& abilities, const ResolvedMatchOptions& options,
                       const MatchRequest& request = {});
SearchPlan search_plan(const ResolvedMatchOptions& options, const MatchSize& size);

/// One line if matching needs more than `machine_bytes` (0: not known), with photographs and maps;
/// empty if it does not.
std::string memory_obstacle(const ResolvedMatchOptions& options, const MatchSize& size,
                            std::size_t machine_bytes);

}  // namespace vantage
