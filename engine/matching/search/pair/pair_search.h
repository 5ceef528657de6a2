#pragma once

#include <array>

#include "engine/image/image.h"
#include "engine/matching/costs/intensity_planes.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/search/level_map_search.h"
#include "engine/matching/windows/reduced_images.h"

namespace vantage {

/// Working memory of a PairSearch, reused without reallocation.
struct PairMemory : LevelMemory {
  PreparedPair pair;
  LevelVolume right_energies;           ///< selection symmetric
  std::array<ReducedImages, 2> halves;  ///< of both images, to find what changed

  void add_use(MemoryUse& use) const;
};

/// Both maps of a rectified pair, at its size: flat or coarse to fine.
class PairSearch final : public LevelMapSearch {
 public:
  PairSearch(SearchJob& job, PairMemory& memory) : LevelMapSearch(job, memory), own_(memory) {}
  static SearchPlan plan(const ResolvedMatchOptions& options, const MatchSize& size);

  void start() override;
  std::array<const Photograph*, 2> half_size_images() override;
  void prepare() override;
  void search(MapTask& task) override;
  void refine(RefinementWork& work) override;

 private:
  const ChainInput& input_of(const MapTask& task) override { return inputs_[index_of(task.side)]; }
  void prepare_images(const kernels::CandidateGeometry& geometry);
  void prepare_column_ssd(const kernels::CandidateGeometry& geometry);
  [[nodiscard]] bool can_share_costs() const;
  void start_symmetric(const MapTask& task);

  PairMemory& own_;
  std::array<ChainInput, 2> inputs_;
  SymmetricPlace place_;  ///< selection symmetric
};

}  // namespace vantage
