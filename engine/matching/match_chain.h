#pragma once

#include <memory>
#include <vector>

#include "engine/image/image.h"
#include "engine/matching/intensity_planes.h"
#include "engine/matching/match_options.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// The candidates of `options` that some pixel of an image `width` columns wide can have.
/// `reference` is the image whose grid the map is on. Throws Error when there is none.
kernels::CandidateGeometry candidate_geometry(const MatchOptions& options, Reference reference,
                                              int width, int height);

/// The stages that compute one disparity map: cost → aggregation → selection.
class MatchChain {
 public:
  /// `pair` as filled by prepare_pair() for the same geometry; it and `disparity_px` must outlive
  /// the chain.
  MatchChain(const MatchOptions& options, const kernels::CandidateGeometry& geometry,
             const PreparedPair& pair, ImageView<float> disparity_px);

  [[nodiscard]] scheduler::Chain stages() const { return pointers_; }

 private:
  void add(std::unique_ptr<scheduler::RowStage> stage);

  std::vector<std::unique_ptr<scheduler::RowStage>> stages_;
  std::vector<const scheduler::RowStage*> pointers_;
};

}  // namespace vantage
