#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/costs/intensity_planes.h"
#include "engine/matching/costs/stage_cost.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Whether box sums of squared differences of luma can be made by the column SSD stage, which is
/// faster than making costs first and summing them: the maps are the same. Levels need the costs.
bool uses_column_ssd(const MethodParameters& parameters);

/// What a chain compares: the pair, for the column SSD stage, or a reference and its partners.
struct ChainInput {
  const PreparedPair* pair = nullptr;  ///< else the rest counts
  const CostImage* reference = nullptr;
  std::vector<CostPartner> partners;
  /// Disparities that pixels are drawn towards, on the reference's grid; empty: none. Not beside
  /// `pair`. See DisparityPrior.
  ImageView<const float> prior_px = {};
  double prior_weight = 0;
  /// How neighbours in the reference count for each other, one for each level, the image's own
  /// first; empty: all alike. See EdgeWeightLevels.
  std::span<const EdgeWeights> edges = {};
  /// Of a search in two dimensions, of one partner and without a prior, whose disparity_y_px does
  /// not count; the geometry is then that of the grid's columns. Null: along rows only.
  const DisplacementGrid* grid = nullptr;
};

/// Where a chain stands in matching from coarse to fine. Volumes are of the format of the method
/// (stage_level_likelihoods for Bayesian diffusion, whose results with the prior's largest term are
/// those of stage_fixed_energies; stage_level_energies for others), of their level's size, and
/// outlive the chain. As it is: the only level.
struct ChainLevel {
  int number = 0;  ///< 0: the image's own
  /// What levels above the image's own start from, in place of costs; null: costs of the input.
  const LevelVolume* costs = nullptr;
  const LevelVolume* coarser = nullptr;  ///< result of the next coarser level; null: there is none
  LevelVolume* result = nullptr;         ///< where cells go in place of winners
  /// Where costs go, reduced to the next coarser level: nothing else is made.
  LevelVolume* reduced = nullptr;
  /// Bayesian diffusion: the candidates that are looked at, here and on the coarser level; null:
  /// all. Where this level has fewer than all, there is a coarser one.
  const CandidateBlocks* blocks = nullptr;
  const CandidateBlocks* coarser_blocks = nullptr;
  /// Beside `result`: where the most probable candidates go; null: not wanted.
  Image<std::int32_t>* winners = nullptr;
};

/// The stages that compute one disparity map, or one level of it: cost → aggregation → selection.
class MatchChain {
 public:
  /// `parameters` must be valid. What `input` points at and the outputs must outlive the chain.
  /// `geometry`: of the level.
  MatchChain(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
             const ChainInput& input, const MapOutputs& outputs, const ChainLevel& level = {});

  [[nodiscard]] scheduler::Chain stages() const { return pointers_; }
  /// Stage counts after which to cut the chain so that each pass holds `iterations`, see
  /// scheduler::PlanRequest.
  [[nodiscard]] std::vector<int> pass_ends(int iterations) const;

 private:
  void add(std::unique_ptr<scheduler::RowStage> stage);
  void add_all(std::vector<std::unique_ptr<scheduler::RowStage>> stages);
  void add_reduction(const MethodParameters& parameters, const ChainInput& input,
                     const ChainLevel& level);
  void add_costs(const MethodParameters& parameters, const ChainInput& input,
                 const ChainLevel& level);
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> level_costs(const MethodParameters& parameters,
                                                                 const ChainLevel& level) const;
  [[nodiscard]] kernels::CandidateGeometry of_candidates(int first_candidate, int count) const;
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> plain_costs(const MethodParameters& parameters,
                                                                 const ChainInput& input,
                                                                 int first_candidate,
                                                                 int count) const;
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> costs_of(const MethodParameters& parameters,
                                                              const ChainInput& input,
                                                              int first_candidate, int count) const;
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> byte_energies(
      const MethodParameters& parameters, const ChainInput& input, int first_candidate,
      int count) const;
  void add_column_ssd(const MethodParameters& parameters, const PreparedPair& pair);
  void add_box(const MethodParameters& parameters, const ChainInput& input);
  void add_aggregation(const MethodParameters& parameters, const ChainInput& input,
                       const ChainLevel& level);
  void add_result(const MethodParameters& parameters, const ChainLevel& level);
  void add_selection(const MethodParameters& parameters, const ChainInput& input,
                     const ChainLevel& level);

  kernels::CandidateGeometry geometry_;
  MapOutputs outputs_;
  int height_;            ///< of the level
  float half_scale_ = 1;  ///< of volumes that hold energies
  int first_iteration_ = 0;
  int iterations_ = 0;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages_;
  std::vector<const scheduler::RowStage*> pointers_;
};

}  // namespace vantage
