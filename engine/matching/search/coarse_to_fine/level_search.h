#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/side.h"
#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/search/coarse_to_fine/search_report.h"
#include "engine/matching/volume/volume_request.h"
#include "engine/matching/volume/volume_writer.h"
#include "kernels/candidates.h"

namespace vantage {

/// Computes single maps from prepared images: at full size or coarse to fine (CoarseToFine), along
/// rows or in two dimensions (5.5.3).
class LevelSearch {
 public:
  /// `parameters`: those of `options`, plus the values estimated from the images. All must outlive
  /// the search. Fills `report`.
  LevelSearch(const ResolvedMatchOptions& options, const MethodParameters& parameters,
              Execution& execution, CoarseLevels& levels, SearchReport& report)
      : options_(options),
        parameters_(parameters),
        execution_(execution),
        levels_(levels),
        report_(report) {}

  /// `volumes`: those whose side is `reference` are written; none with a coarse map alone or parts,
  /// which need candidates of whole pixels. Throws Error when no pixel has a candidate, UsageError
  /// for a level of a volume that the image does not have.
  void compute(Side reference, const ChainInput& input, const WantedWinners& wanted,
               std::span<const VolumeRequest> volumes = {});

  /// The plan that compute() reports, on other executions of the same machine, without computing
  /// anything.
  [[nodiscard]] std::vector<scheduler::ChainPlan> plans(
      Side reference, const ChainInput& input, const MapOutputs& size,
      std::span<const ExecutionOptions> executions) const;

 private:
  /// The candidates of a map.
  struct Candidates {
    kernels::CandidateGeometry along_rows;
    std::optional<DisplacementGrid> grid;  ///< empty: along rows only
    [[nodiscard]] kernels::CandidateGeometry geometry() const {
      return grid ? grid->columns() : along_rows;
    }
  };
  [[nodiscard]] Candidates candidates_of(Side reference, const ChainInput& input,
                                         scheduler::Extent image) const;
  void search(const SearchedImage& image, const WantedWinners& wanted,
              const std::vector<VolumeWriter>& writers);
  [[nodiscard]] std::vector<VolumeWriter> start_writers(
      Side reference, const Candidates& candidates, int height_px,
      std::span<const VolumeRequest> volumes) const;

  const ResolvedMatchOptions& options_;
  const MethodParameters& parameters_;
  Execution& execution_;
  CoarseLevels& levels_;
  SearchReport& report_;
};

}  // namespace vantage
