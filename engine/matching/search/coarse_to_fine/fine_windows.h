#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/image.h"
#include "engine/image/tile_mask.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/windows/coarse_beliefs.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Working memory of FineWindows, reused without reallocation.
struct FineWindowsWork {
  WindowState state;       ///< of level 1
  WindowState finest;      ///< of level 0, for callers that want it
  DisparityMap coarse_px;  ///< of level 1, not read
  /// Of level 1, for callers that keep none.
  Image<std::int32_t> winners;

  [[nodiscard]] std::size_t held_bytes() const;
};

/// The finest levels of a coarse-to-fine search, searched in windows (EQUATIONS §3.13). All
/// references must outlive the object.
class FineWindows {
 public:
  /// parameters, geometry, input: of the image; a single partner, prepared for window_margins().
  FineWindows(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
              const ChainInput& input, Execution& execution, FineWindowsWork& work)
      : parameters_(parameters),
        geometry_(geometry),
        input_(input),
        execution_(execution),
        work_(work) {}

  /// Searches level 1 from the beliefs of level 2. regions: the only ones to search; null: all.
  /// winners: numbers of candidates, resized.
  void search_level_1(const CoarseBeliefs& coarse, scheduler::Extent extent,
                      const std::vector<scheduler::Region>* regions, Image<std::int32_t>& winners);
  /// Searches level 0. coarse: of level 1; null: those of search_level_1(). tiles: the only ones to
  /// write; null: all. state: null: not requested.
  void search_level_0(const CoarseBeliefs* coarse, const MapOutputs& outputs, const TileMask* tiles,
                      WindowState* state);

 private:
  const MethodParameters& parameters_;
  const kernels::CandidateGeometry& geometry_;
  const ChainInput& input_;
  Execution& execution_;
  FineWindowsWork& work_;
};

}  // namespace vantage
