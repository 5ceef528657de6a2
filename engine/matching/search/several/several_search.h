#pragma once

#include <array>
#include <cstddef>

#include "engine/matching/search/level_map_search.h"

namespace vantage {

/// Working memory of a SeveralSearch, reused without reallocation.
struct SeveralMemory : LevelMemory {
  /// Maps of the nearest image of either side, to check the reference's.
  std::array<MatchedMap, 2> partner_maps;

  void add_use(MemoryUse& use) const;
};

/// The map of the first image against all others at once (6.6). For the cross-check, also those of
/// the nearest image of either side. Without windows, which compare two images.
class SeveralSearch final : public LevelMapSearch {
 public:
  SeveralSearch(SearchJob& job, SeveralMemory& memory)
      : LevelMapSearch(job, memory), own_(memory) {}
  static SearchPlan plan(const ResolvedMatchOptions& options, const MatchSize& size);

  void start() override;
  void prepare() override;
  void search(MapTask& task) override { search_levels(task, input_); }
  void refine(RefinementWork& work) override;

 private:
  const ChainInput& input_of(const MapTask& /*task*/) override { return input_; }
  void prepare_map(const MapTask& task, std::size_t own);
  std::vector<PartnerMap> search_partners();

  SeveralMemory& own_;
  ChainInput input_;  ///< of the map being computed
};

}  // namespace vantage
