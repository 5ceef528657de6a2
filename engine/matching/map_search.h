#pragma once

#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/match_report.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/volume/volume_request.h"
#include "engine/matching/volume/volume_writer.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Execution plan of a chain on `threads` threads.
scheduler::ChainPlan chain_plan(const MatchChain& chain, const ExecutionOptions& execution,
                                int threads, const scheduler::Machine& machine);

/// Working memory of MapSearch, reused without reallocation.
struct MapSearchWork {
  CoarseLevels levels;
};

/// Computes single maps: flat or coarse to fine, along rows or in two dimensions (5.5.3).
class MapSearch {
 public:
  /// `parameters`: those of `options`, plus the values estimated from the images. All must outlive
  /// the search. Fills plan and cells of `report`.
  MapSearch(const ResolvedMatchOptions& options, const MethodParameters& parameters,
            Execution& execution, MapSearchWork& work, MatchReport& report)
      : options_(options),
        parameters_(parameters),
        execution_(execution),
        work_(work),
        report_(report) {}

  /// `outputs` have the image's size; with coarse.is_only only that size is used. `volumes`: those
  /// whose side is `reference` are written; none with coarse.is_only. `parts`: the only ones to
  /// compute, see match_coarse_to_fine(), with candidates of whole pixels; null: all. Throws Error
  /// when no pixel has a candidate, UsageError for a level of a volume that the image does not
  /// have.
  void compute(Side reference, const ChainInput& input, const MapOutputs& outputs,
               const CoarseMap& coarse, const CheckMap& check = {},
               std::span<const VolumeRequest> volumes = {}, const SearchedParts* parts = nullptr);

 private:
  void search(const kernels::CandidateGeometry& geometry, const ChainInput& searched,
              const MapOutputs& outputs, const CoarseMap& coarse, const CheckMap& check,
              const std::vector<VolumeWriter>& writers, const SearchedParts* parts);
  [[nodiscard]] std::vector<VolumeWriter> start_writers(
      Side reference, scheduler::Extent image, const kernels::CandidateGeometry& along_rows,
      std::span<const VolumeRequest> volumes) const;
  void run_chain(const MatchChain& chain);

  const ResolvedMatchOptions& options_;
  const MethodParameters& parameters_;
  Execution& execution_;
  MapSearchWork& work_;
  MatchReport& report_;
};

}  // namespace vantage
