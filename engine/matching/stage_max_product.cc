#include "engine/matching/stage_max_product.h"

#include <cstddef>
#include <optional>
#include <span>

#include "engine/image/image.h"
#include "engine/matching/block_star.h"
#include "engine/matching/column_work.h"
#include "engine/matching/energy_format.h"
#include "engine/matching/star_stage.h"
#include "kernels/edge_weights/edge_weights.h"
#include "kernels/max_product_step/max_product_step.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using kernels::FixedWeight;

/// What all stages know of the prior.
class PriorRises {
 public:
  PriorRises(const MethodParameters& parameters, int count)
      : rises_(EnergyFormat(parameters).prior_rises(parameters.sigma_prior, count)),
        ceiling_(EnergyFormat(parameters).ceiling()) {}

  [[nodiscard]] int radius() const { return static_cast<int>(rises_.size()); }
  [[nodiscard]] kernels::EnergyPrior prior() const { return {rises_.data(), radius(), ceiling_}; }

 private:
  std::vector<FixedEnergy> rises_;
  FixedEnergy ceiling_;
};

/// Working memory of a kernel on columns of so many lanes, of blocks that need not be neighbours.
std::size_t work_cells(int lanes, int radius, const CandidateBlocks* blocks) {
  const int segments = blocks == nullptr ? 1 : lanes / kernels::kLaneMultiple;
  return static_cast<std::size_t>(kernels::max_product_work_cells(lanes, radius, segments));
}

class MaxProductStage final : public CellStarStage<FixedEnergy> {
 public:
  /// is_start: the state before the first iteration. smooths: iterations follow.
  MaxProductStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
                  int height, bool is_start, bool smooths, const EdgeWeights* edges,
                  const CandidateBlocks* blocks)
      : CellStarStage(cell_geometry(geometry, blocks), height),
        is_start_(is_start),
        smooths_(smooths),
        mu_(static_cast<float>(parameters.mu)),
        rises_(parameters, geometry.count),
        edges_(edges),
        neutral_(lanes(), 1),
        blocks_(blocks) {
    neutral_.fill(0);
    if (blocks != nullptr) {
      stars_.emplace(*blocks, rises_.prior().ceiling);
    }
  }

  [[nodiscard]] std::string_view name() const override {
    return is_start_ ? "Bayes start" : "Bayes iteration";
  }
  [[nodiscard]] bool reads_source() const override { return !is_start_; }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return is_start_ ? RowStage::input_rows(y, input) : CellStarStage::input_rows(y, input);
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return is_start_ ? RowStage::input_columns(columns, input)
                     : CellStarStage::input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return is_start_ ? 1 : 3; }
  /// Of the kernel, of stars, and weights of a row.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(FixedEnergy) * (kernel_cells() + star_cells()) +
           (edges_ == nullptr
                ? 0
                : sizeof(FixedWeight) * (3 * static_cast<std::size_t>(columns.size()) + 1));
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const kernels::KernelWork work =
        is_start_ ? kernels::max_product_start_work(rises_.radius())
                  : kernels::max_product_work(rises_.radius(), smooths_, edges_ != nullptr);
    return vantage::column_work(work, candidates_in(blocks_, count()));
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::MaxProductRow row;
    row.prior = rises_.prior();
    row.mu = kernels::fixed_weight(mu_);
    row.smooths = smooths_;
    row.output = reinterpret_cast<FixedEnergy*>(task.output);
    row.source_pitch = row.output_pitch = lanes();
    row.work = reinterpret_cast<FixedEnergy*>(task.state);
    FixedEnergy* const star_work = row.work + kernel_cells();
    if (edges_ != nullptr && !is_start_) {
      row.weights = make_weights(task, star_work + star_cells());
    }
    if (blocks_ == nullptr) {
      row.star = star(task, lanes(), neutral_.row(0));
      make_columns(row);
      return;
    }
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      const BlockSegments segments(run.blocks);
      row.star = stars_->star(task, run, neutral_.row(0), star_work);
      row.segment_ends = segments.ends();
      make_columns(row);
      row.output += run.columns.size() * row.output_pitch;
      if (row.weights.are_given()) {
        row.weights.beside += run.columns.size();
        row.weights.above += run.columns.size();
        row.weights.below += run.columns.size();
      }
      x = run.columns.end;
    }
  }

 private:
  void make_columns(kernels::MaxProductRow& row) const {
    if (is_start_) {
      row.star.source = row.star.centre;
      kernels::max_product_start_row(row);
    } else {
      kernels::max_product_row(row);
    }
  }
  [[nodiscard]] std::size_t kernel_cells() const {
    return work_cells(lanes(), rises_.radius(), blocks_);
  }
  [[nodiscard]] std::size_t star_cells() const { return stars_ ? stars_->work_cells() : 0; }

  /// Of the columns of a task, from its first one on.
  kernels::EnergyStarWeights make_weights(const scheduler::RowTask& task,
                                          FixedWeight* weights) const {
    const int x = task.columns.begin;
    const int columns = task.columns.size();
    FixedWeight* const beside = weights;
    FixedWeight* const above = beside + columns + 1;
    FixedWeight* const below = above + columns;
    kernels::fixed_weights_row(edges_->beside(task.y) + x, columns + 1, mu_, beside);
    kernels::fixed_weights_row(edges_->above(task.y) + x, columns, mu_, above);
    kernels::fixed_weights_row(edges_->above(task.y + 1) + x, columns, mu_, below);
    return {.beside = beside, .above = above, .below = below};
  }

  bool is_start_;
  bool smooths_;
  float mu_;
  PriorRises rises_;
  const EdgeWeights* edges_;
  Image<FixedEnergy> neutral_;  ///< stands for the neighbours outside the image
  const CandidateBlocks* blocks_;
  std::optional<BlockStars<FixedEnergy>> stars_;  ///< where there are blocks
};

class MaxProductFromCoarserStage final : public FromCoarserStage<FixedEnergy> {
 public:
  MaxProductFromCoarserStage(const MethodParameters& parameters,
                             const kernels::CandidateGeometry& geometry, int height, bool smooths,
                             const CoarserResult& coarser, const CandidateBlocks* blocks)
      : FromCoarserStage(geometry, height, coarser, blocks),
        smooths_(smooths),
        rises_(parameters, geometry.count),
        byte_steps_(EnergyFormat(parameters).of_result()) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::max_product_start_from_coarser_work(rises_.radius()),
                                candidates());
  }

 protected:
  /// Energies, and what smoothing needs.
  [[nodiscard]] std::size_t work_cells() const override {
    return energy_cells() + vantage::work_cells(lanes(), rises_.radius(), blocks());
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
    row.segment_ends = segment_ends;
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
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const CoarserResult& coarser, const EdgeWeights* edges, const CandidateBlocks* blocks) {
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    const bool is_start = i == 0;
    const bool smooths = i < parameters.iterations;
    if (is_start && coarser.volume != nullptr) {
      stages.push_back(std::make_unique<MaxProductFromCoarserStage>(parameters, geometry, height,
                                                                    smooths, coarser, blocks));
      continue;
    }
    stages.push_back(std::make_unique<MaxProductStage>(parameters, geometry, height, is_start,
                                                       smooths, edges, blocks));
  }
  return stages;
}

}  // namespace vantage
