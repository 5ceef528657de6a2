#include "engine/matching/aggregation/stage_max_product.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/column_work.h"
#include "engine/matching/aggregation/bayes_step_stage.h"
#include "engine/matching/levels/block_star.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "kernels/max_product_step/max_product_step.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using kernels::FixedWeight;

/// Properties of the prior that all stages share.
class PriorRises {
 public:
  PriorRises(const MethodParameters& parameters, const AggregationPlace& place)
      : plane_(place.plane),
        rises_(parameters.prior == Prior::kImpulse
                   ? std::vector<FixedEnergy>{}
                   : EnergyFormat(parameters)
                         .prior_rises(parameters.sigma_prior, place.geometry.count)),
        ceiling_(EnergyFormat(parameters).ceiling()) {}

  [[nodiscard]] int radius() const { return static_cast<int>(rises_.size()); }
  [[nodiscard]] kernels::EnergyPrior prior() const { return {rises_.data(), radius(), ceiling_}; }
  [[nodiscard]] const kernels::CandidatePlane& plane() const { return plane_; }
  /// Radius of one-dimensional smoothing with the same number of operations: two dimensions take
  /// two passes.
  [[nodiscard]] int radius_of_work() const { return plane_.is_given() ? 2 * radius() : radius(); }

 private:
  kernels::CandidatePlane plane_;
  std::vector<FixedEnergy> rises_;
  FixedEnergy ceiling_;
};

class MaxProductStage final : public BayesStepStage<FixedEnergy> {
 public:
  /// iteration: 0: the start, the state before the first one.
  MaxProductStage(const MethodParameters& parameters, const AggregationPlace& place, int iteration)
      : BayesStepStage(cell_geometry(place.geometry, place.blocks), place.height, iteration == 0,
                       0),
        smooths_(iteration < parameters.iterations),
        mu_(kernels::fixed_weight(static_cast<float>(parameters.mu))),
        rises_(parameters, place),
        edges_(weights_of_iteration(place.edges, iteration)),
        blocks_(place.blocks) {
    if (blocks_ != nullptr) {
      stars_.emplace(*blocks_, EnergyFormat(parameters).ceiling());
    }
  }

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const kernels::KernelWork work =
        is_start()
            ? kernels::max_product_start_work(rises_.radius_of_work())
            : kernels::max_product_work(rises_.radius_of_work(), smooths_, edges_ != nullptr);
    return vantage::column_work(work, candidates_in(blocks_, count()));
  }
  /// Working memory of the kernel and of stars.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(FixedEnergy) * (work_cells() + (stars_ ? stars_->work_cells() : 0));
  }

  void make_row(const scheduler::RowTask& task) const override {
    Columns columns;
    columns.output = reinterpret_cast<FixedEnergy*>(task.output);
    columns.work = reinterpret_cast<FixedEnergy*>(task.state);
    columns.x = task.columns.begin;
    columns.y = task.y;
    if (blocks_ == nullptr) {
      columns.star = step_star(task);
      make_columns(columns);
      return;
    }
    FixedEnergy* const star_work = columns.work + work_cells();
    while (columns.x < task.columns.end) {
      const CandidateBlocks::Run run = blocks_->run_at(columns.x, task.y, task.columns.end);
      if (run.is_wanted) {
        const BlockSegments segments(run.blocks);
        columns.star = stars_->star(task, run, neutral(), star_work);
        columns.segment_ends = segments.ends();
        make_columns(columns);
      }
      columns.output += static_cast<std::ptrdiff_t>(run.columns.size()) * lanes();
      columns.x = run.columns.end;
    }
  }

 private:
  /// Columns of a row with the same candidates.
  struct Columns {
    kernels::CellStarRow<FixedEnergy> star;
    int x = 0;  ///< first column
    int y = 0;
    std::span<const int> segment_ends;  ///< ends of runs of consecutive candidates; empty: one run
    FixedEnergy* output = nullptr;      ///< lanes() per column, as star.source
    FixedEnergy* work = nullptr;        ///< work_cells(), 64-byte aligned
  };

  /// Working cells of the kernel.
  [[nodiscard]] std::size_t work_cells() const {
    return static_cast<std::size_t>(kernels::max_product_work_cells(
        lanes(), rises_.radius(), max_segments(lanes(), blocks_), rises_.plane()));
  }

  void make_columns(const Columns& columns) const {
    kernels::MaxProductRow row;
    row.star = columns.star;
    row.prior = rises_.prior();
    row.mu = mu_;
    row.smooths = smooths_;
    row.segment_ends = columns.segment_ends;
    row.plane = rises_.plane();
    row.output = columns.output;
    row.source_pitch = row.output_pitch = lanes();
    row.work = columns.work;
    if (is_start()) {
      kernels::max_product_start_row(row);
      return;
    }
    if (edges_ != nullptr) {
      row.weights = {.beside = edges_->fixed_beside(columns.y) + columns.x,
                     .above = edges_->fixed_above(columns.y) + columns.x,
                     .below = edges_->fixed_above(columns.y + 1) + columns.x};
    }
    kernels::max_product_row(row);
  }

  bool smooths_;  ///< iterations follow
  FixedWeight mu_;
  PriorRises rises_;
  const EdgeWeightPlanes* edges_;
  const CandidateBlocks* blocks_;
  std::optional<BlockStars> stars_;  ///< set if there are blocks
};

class MaxProductFromCoarserStage final : public FromCoarserStage<FixedEnergy> {
 public:
  MaxProductFromCoarserStage(const MethodParameters& parameters, const AggregationPlace& place)
      : FromCoarserStage(place.geometry, place.height, {place.coarser, place.coarser_blocks},
                         place.blocks),
        smooths_(parameters.iterations > 0),
        rises_(parameters, place),
        byte_steps_(EnergyFormat(parameters).of_result()) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        kernels::max_product_start_from_coarser_work(rises_.radius_of_work()), candidates());
  }

 protected:
  /// Energies and smoothing buffers.
  [[nodiscard]] std::size_t work_cells() const override {
    return energy_cells() +
           static_cast<std::size_t>(kernels::max_product_work_cells(
               lanes(), rises_.radius(), max_segments(lanes(), blocks()), rises_.plane()));
  }

  void make_states(const kernels::CompactRow& coarser, std::span<const int> segment_ends,
                   FixedEnergy* states, FixedEnergy* work) const override {
    kernels::fixed_energies_of_bytes_row(coarser, byte_steps_, work);
    kernels::MaxProductRow row;
    row.star.centre = row.star.up = row.star.down = row.star.source = work;
    row.star.left_of_first = row.star.right_of_last = work;
    row.star.columns = coarser.columns;
    row.star.lanes = coarser.lanes;
    row.prior = rises_.prior();
    row.smooths = smooths_;
    row.output = states;
    row.source_pitch = row.output_pitch = coarser.lanes;
    if (rises_.plane().is_given()) {
      row.plane = rises_.plane();
    } else {
      row.segment_ends = segment_ends;
    }
    row.work = work + energy_cells();
    kernels::max_product_start_row(row);
  }

 private:
  [[nodiscard]] std::size_t energy_cells() const {
    return kCoarserColumns * static_cast<std::size_t>(lanes());
  }

  bool smooths_;
  PriorRises rises_;
  kernels::ByteSteps byte_steps_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_max_product_stages(
    const MethodParameters& parameters, const AggregationPlace& place) {
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    if (i == 0 && place.coarser != nullptr) {
      stages.push_back(std::make_unique<MaxProductFromCoarserStage>(parameters, place));
    } else {
      stages.push_back(std::make_unique<MaxProductStage>(parameters, place, i));
    }
  }
  return stages;
}

}  // namespace vantage
