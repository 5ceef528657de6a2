#pragma once

#include <array>

#include "engine/matching/search/map_search.h"
#include "engine/matching/search/reduced/reduced_map.h"
#include "engine/object_pool.h"

namespace vantage {

/// Both maps of a pair from reduced images (EQUATIONS §3.13): winners at half size (ReducedMap),
/// refinement at half size; the maps, enlarged.
class ReducedSearch final : public MapSearch {
 public:
  using ImagePool = ObjectPool<DeferredMatch::Images>;

  /// `lent`: images of calls that are left for later. All must outlive the object.
  ReducedSearch(SearchJob& job, ReducedMemory& memory, ImagePool& lent)
      : MapSearch(job), memory_(memory), lent_(lent) {}
  static SearchPlan plan(const ResolvedMatchOptions& options, const MatchSize& size);

  void start() override;
  void resume(DeferredMatch& deferred) override;
  std::array<const Photograph*, 2> half_size_images() override;
  void defer(DeferredMatch& deferred) override;
  void prepare() override;
  void search(MapTask& task) override;
  void refine(RefinementWork& work) override;

 private:
  void add_tasks();
  [[nodiscard]] CostSharing sharing_of(Side side) const;
  void refine_halves(RefinementWork& work);

  ReducedMemory& memory_;
  ImagePool& lent_;
  DisparityRange range_ = {0, 0};  ///< of the images, without what no pixel can have
};

}  // namespace vantage
