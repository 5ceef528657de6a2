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
#include "engine/matching/selection/row_energies.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/volume/volume_writer.h"
#include "scheduler/strip_plan.h"

namespace vantage {

struct CostBounds;

/// Whether the column SSD stage can compute box sums of squared luma differences: the same maps,
/// faster than computing and then summing costs. Not with several levels, which need the costs.
bool uses_column_ssd(const MethodParameters& parameters);

/// Whether the costs of coarse levels are made once for both images of a pair.
enum class CostSharing : std::uint8_t {
  kNone,
  kStores,  ///< the left image's map: those of the right image are stored, too
  kUses,    ///< the right image's map, after the left one's: the stored ones are used
};

/// The chains of both images in a symmetric selection: that of the right image stores its energies,
/// that of the left one selects both maps.
struct SymmetricPlace {
  LevelVolume* right = nullptr;   ///< energies in steps, of the image's size
  bool is_stored = false;         ///< whether `right` is input
  MapOutputs right_outputs = {};  ///< of the left image's chain
};

/// Input of a chain: the pair, for the column SSD stage, or a reference and its partners. Both, if
/// a volume of costs is wanted besides.
struct ChainInput {
  const PreparedPair* pair = nullptr;  ///< null: the other members are used
  const CostImage* reference = nullptr;
  std::vector<CostPartner> partners;
  /// Disparities that attract pixels, on the reference's grid; empty: none. Not with `pair`. See
  /// DisparityPrior.
  ImageView<const float> prior_px = {};
  double prior_weight = 0;
  /// Weights of neighbours in the reference, per level, the image's own first; empty: all 1. See
  /// EdgeWeightLevels.
  std::span<const EdgeWeights> edges = {};
  /// Selection symmetric: the place of this chain; null: for plans only.
  const SymmetricPlace* symmetric = nullptr;
  /// Only if shares_costs().
  CostSharing sharing = CostSharing::kNone;
  /// Grid of a two-dimensional search with one partner (its disparity_y_px is ignored) and no
  /// prior; the geometry is then that of the grid's columns. Null: search along rows only.
  const DisplacementGrid* grid = nullptr;
};

/// Position of a chain in coarse-to-fine matching. Volumes have the format of the method
/// (stage_level_likelihoods for Bayesian diffusion, whose results with the prior's largest term are
/// those of stage_fixed_energies; stage_half_energies for others) and the size of their level, and
/// outlive the chain. Default: the only level.
struct ChainLevel {
  int number = 0;  ///< 0: the image's own
  /// Input of levels coarser than the image; null: costs of the input.
  const LevelVolume* costs = nullptr;
  const LevelVolume* coarser = nullptr;  ///< result of the next coarser level; null: none
  LevelVolume* result = nullptr;         ///< output for cells, instead of winners
  /// Output for costs, reduced to the next coarser level; nothing else is computed.
  LevelVolume* reduced = nullptr;
  /// With `reduced`, for the left image: output for the right image's costs, too. Null: not
  /// requested. Only if shares_costs().
  LevelVolume* reduced_right = nullptr;
  /// Bayesian diffusion: the candidates processed, here and on the coarser level; null: all. If
  /// this level is pruned, there is a coarser one.
  const CandidateBlocks* blocks = nullptr;
  const CandidateBlocks* coarser_blocks = nullptr;
  /// Output for the most probable candidates, in addition to `result`; null: not requested.
  Image<std::int32_t>* winners = nullptr;
  /// The only parts of the outputs to make; null: all.
  const std::vector<scheduler::Region>* regions = nullptr;
  /// The only rows of the outputs to make, instead of `regions`; empty: all. With `result` or
  /// `reduced`.
  std::optional<scheduler::Range> rows = std::nullopt;
  /// Takes the level's cells: aggregated ones in addition to the other outputs, costs instead of
  /// them. Null: not requested.
  const VolumeWriter* volume = nullptr;
};

/// Whether the costs of both images' coarse levels can be reduced together, in the method and, for
/// the second, in the search of `input`, over so many candidates. Larger images make them one after
/// the other: what is stored for the second one would be too much memory.
bool can_share_costs(const MethodParameters& parameters, scheduler::Extent image, int candidates);
bool shares_costs(const MethodParameters& parameters, const ChainInput& input,
                  scheduler::Extent image, int candidates);

// Cells of a row are [x][candidate]: floats (energies or likelihoods), bytes (energies in steps),
// fixed point of 16 bits (EnergyFormat), window sums of 32 bits. Stored levels hold bytes or half
// floats. Source: the first stage of the chain, read again. Halo: rows and columns read beyond
// those made; r: radius of the window or kernel.
//
// clang-format off
//  stage                          reads                   halo       outside the image      makes
//  -----------------------------  ----------------------  ---------  ---------------------  --------
//  cost                           images                             value without partner  float
//  ray census energy              images                             largest byte           byte
//  disparity prior                a cost stage                       as the cost            float
//  displacement cost              a stage per row shift              padding value          as read
//  fixed energy                   bytes or floats                    as read                fixed
//  block source                   a stage per block                  as read                fixed
//  column SSD                     images                  r rows     left out of sums       32 bits
//  column and displacement sum    float                   r rows     left out of sums       32 bits
//  box mean                       float                   r, both    left out of means      float
//  convolution, box cascade       float                   r          0                      float
//  diffusion, local stopping      float                   1, both    left out               float
//  membrane                       float, source           1, both    left out               float
//  Bayes start, iteration         float, source           1, both    neutral column         float
//  max product start, iteration   fixed, source           1, both    neutral column         fixed
//  level half energy, likelihood  stored level                                              float
//  level fixed energy             stored level                                              fixed
//  coarser half energy            float, coarser row y/2                                    float
//  start from coarser             coarser row y/2                                           as level
//  reduction                      rows 2y and 2y + 1                 last row repeated      stored
//  pair reduction                 a cost stage, 2y and 2y + 1        last row repeated      2 stored
//  store, result                  cells of the level                                        stored
//  window selection               32 bits                 r columns  border: valid or clip  map
//  cell, displacement selection   float                              NaN if no candidate    map
//  fixed energy selection         fixed                              NaN if no candidate    map
//  scanline selection             float, fixed, 32 bits   whole row  NaN if no candidate    map
//  store energies                 float, fixed, 32 bits   whole row                         stored
//  symmetric selection            same, stored row        whole row  NaN if unmatched       maps
//  volume                         float, fixed                       NaN if no partner      volume
// clang-format on

/// The stages that compute one disparity map, or one level of it: cost → aggregation → selection.
class MatchChain {
 public:
  /// `parameters` must be valid. The targets of `input` and the outputs must outlive the chain.
  /// `geometry`: of the level.
  MatchChain(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
             const ChainInput& input, const MapOutputs& outputs, const ChainLevel& level = {});

  [[nodiscard]] scheduler::Chain stages() const { return pointers_; }
  /// Stage counts at which to cut the chain so that each pass holds `iterations`; see
  /// scheduler::PlanRequest.
  [[nodiscard]] std::vector<int> pass_ends(int iterations) const;
  /// ChainLevel::regions, on the grid of the last stage; null: everything is computed.
  [[nodiscard]] const std::vector<scheduler::Region>* regions() const {
    return regions_ ? &*regions_ : nullptr;
  }
  /// ChainLevel::rows.
  [[nodiscard]] std::optional<scheduler::Range> rows() const { return rows_; }

 private:
  void add(std::unique_ptr<scheduler::RowStage> stage);
  void add_all(std::vector<std::unique_ptr<scheduler::RowStage>> stages);
  [[nodiscard]] static CostBounds bounds_of(const MethodParameters& parameters,
                                            const ChainInput& input);
  // Costs: chain_costs.cc.
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
                                                              const ChainInput& input) const;
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> energy_costs(
      const MethodParameters& parameters, const ChainInput& input, int first_candidate,
      int count) const;
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> byte_energies(
      const MethodParameters& parameters, const ChainInput& input, int first_candidate,
      int count) const;
  // Windows and the selection of winners: chain_selection.cc.
  void add_column_ssd(const MethodParameters& parameters, const ChainInput& input,
                      const ChainLevel& level);
  void add_box(const MethodParameters& parameters, const ChainInput& input,
               const ChainLevel& level);
  void add_window_selection(const MethodParameters& parameters,
                            const WindowSelectionSettings& settings, const ChainInput& input);
  [[nodiscard]] std::unique_ptr<scheduler::RowStage> row_selection(
      const MethodParameters& parameters, const ChainInput& input,
      std::unique_ptr<RowEnergies> energies) const;
  void add_selection(const MethodParameters& parameters, const ChainInput& input,
                     const ChainLevel& level);
  // Aggregation and what is stored.
  void add_aggregation(const MethodParameters& parameters, const ChainInput& input,
                       const ChainLevel& level);
  void add_cost_volume(const MethodParameters& parameters, const ChainInput& input,
                       const ChainLevel& level);
  void add_last(const MethodParameters& parameters, const ChainLevel& level,
                std::unique_ptr<scheduler::RowStage> stage);
  void add_result(const MethodParameters& parameters, const ChainLevel& level);

  kernels::CandidateGeometry geometry_;
  MapOutputs outputs_;
  int height_;  ///< of the level
  std::optional<std::vector<scheduler::Region>> regions_;
  std::optional<scheduler::Range> rows_;
  float half_scale_ = 1;  ///< of volumes that hold energies
  int first_iteration_ = 0;
  int iterations_ = 0;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages_;
  std::vector<const scheduler::RowStage*> pointers_;
};

}  // namespace vantage
