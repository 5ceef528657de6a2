#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/deferred_match.h"
#include "engine/matching/match_report.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/previous_maps.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"
#include "engine/matching/windows/coarse_beliefs.h"
#include "engine/matching/windows/reduced_images.h"
#include "engine/object_pool.h"
#include "engine/refinement/refine_maps.h"
#include "scheduler/range.h"

namespace vantage {

class StageClock;

/// SearchSize::kAuto halves the images until at most so many candidates are left per pixel of the
/// whole image: each reduction leaves an eighth. About equal times for all ranges.
inline constexpr int kMaxFullSizeCandidates = 16;

/// How many times images of this size are halved for the search of these options (search_size); 0:
/// it is done at full size, as in all images of less than 32 rows or columns.
int search_reductions(const ResolvedMatchOptions& options, scheduler::Extent image);

/// The options of the search of all candidates in images halved so many times. `whole_range`: of
/// the images.
ResolvedMatchOptions reduced_options(const ResolvedMatchOptions& options,
                                     DisparityRange whole_range, int reductions);

/// Computes the maps of a pair from reduced images (EQUATIONS §3.13): a coarse-to-fine search of
/// all candidates in halved images, down to half of their size; then levels of windows, each at
/// half the size of the images that it compares; refinement at half size; the maps, enlarged.
///
/// Thread rule: as StereoMatcher.
class ReducedMatcher {
 public:
  /// `options`: valid, with a search size. Both must outlive the object.
  ReducedMatcher(const ResolvedMatchOptions& options, Execution& execution)
      : options_(options), execution_(execution) {}

  /// What of the maps is wanted.
  struct Outputs {
    bool left = true;
    bool right = true;
    bool confidence = false;
  };
  /// Photographs of equal size, for which there are reductions. `previous`: of the pair before,
  /// replaced by those of this one; null: everything is searched. deferred: as
  /// MatchRequest::deferred. Throws Error when no pixel has a candidate.
  void match(const Photograph& left, const Photograph& right, const Outputs& outputs,
             PreviousMaps* previous, DeferredMatch* deferred, DisparityMaps& maps,
             StageClock& clock, MatchReport& report) const;

  void add_memory_use(MemoryUse& use) const;
  /// Memory of match() but for strips and the outputs: about.
  static std::size_t working_bytes(const ResolvedMatchOptions& options, scheduler::Extent image);
  /// Of this, the levels of one map's search; PreviousMaps have some for each map, without bands.
  /// memory_bytes: see level_bands().
  static std::size_t level_bytes(const ResolvedMatchOptions& options, scheduler::Extent image,
                                 std::size_t memory_bytes = kDefaultLevelBytes);
  /// Of a DeferredMatch.
  static std::size_t deferred_bytes(const ResolvedMatchOptions& options, scheduler::Extent image);

 private:
  struct Work {
    DeferredMatch::Images images;
    std::vector<std::array<CostImage, 2>> costs;  ///< [reductions][side]
    EdgeWeightLevels search_edges;
    EdgeWeightLevels window_edges;
    CoarseLevels levels;
    Image<std::int32_t> winners;  ///< of the search
    std::array<WindowState, 2> states;
    DisparityMap coarse_px;  ///< of levels of windows but the last
    DisparityMaps halves;    ///< maps at half size
    RefinementWork refinement;
  };

  [[nodiscard]] std::shared_ptr<DeferredMatch::Images> lend_images() const;
  void prepare_costs(int reductions, Work& work) const;
  /// Winners at half size. `tiles`: the only ones to write; null: all. levels: of the last
  /// call for this side, if there are `tiles`.
  void compute(Side side, int reductions, bool wants_confidence, const TileMask* tiles,
               CostSharing sharing, CoarseLevels& levels, Work& work, MatchedMap& half,
               MatchReport& report) const;
  /// compute() of the tiles to search; the others' winners are those of `previous`.
  void compute_changed(Side side, int reductions, bool wants_confidence, PreviousMaps& previous,
                       Work& work, MatchReport& report) const;
  void refine(const Outputs& outputs, PreviousMaps* previous, Work& work, StageClock& clock) const;

  const ResolvedMatchOptions& options_;
  Execution& execution_;
  mutable ObjectPool<Work> works_;
  mutable ObjectPool<DeferredMatch::Images> deferred_images_;
};

}  // namespace vantage
