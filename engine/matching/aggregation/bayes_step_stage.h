#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "engine/column_work.h"
#include "engine/image/image.h"
#include "engine/matching/aggregation/star_stage.h"
#include "engine/matching/levels/block_star.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The start or an iteration of Bayesian diffusion: what its forms have in common, whatever their
/// cells are. The start makes the state before the first iteration of its input; iterations look at
/// that input again. Cell: float or kernels::FixedEnergy.
template <typename Cell>
class BayesStepStage : public CellStarStage<Cell> {
  using Star = CellStarStage<Cell>;

 public:
  /// neutral: cells of neighbours outside the image. absent: of candidates that a neighbour did not
  /// look at. `blocks`: the candidates that are looked at, in whose lanes cells lie; null: all.
  BayesStepStage(const kernels::CandidateGeometry& geometry, int height, bool is_start,
                 Cell neutral, Cell absent, const CandidateBlocks* blocks)
      : Star(cell_geometry(geometry, blocks), height),
        is_start_(is_start),
        neutral_(Star::lanes(), 1),
        blocks_(blocks) {
    neutral_.fill(neutral);
    if (blocks != nullptr) {
      stars_.emplace(*blocks, absent);
    }
  }

  [[nodiscard]] std::string_view name() const override {
    return is_start_ ? "Bayes start" : "Bayes iteration";
  }
  [[nodiscard]] bool reads_source() const override { return !is_start_; }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return is_start_ ? scheduler::RowStage::input_rows(y, input) : Star::input_rows(y, input);
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return is_start_ ? scheduler::RowStage::input_columns(columns, input)
                     : Star::input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return is_start_ ? 1 : 3; }
  /// Of the kernel and of stars.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(Cell) * (work_cells() + (stars_ ? stars_->work_cells() : 0));
  }

  void make_row(const scheduler::RowTask& task) const override {
    Columns columns;
    columns.output = reinterpret_cast<Cell*>(task.output);
    columns.work = reinterpret_cast<Cell*>(task.state);
    columns.x = task.columns.begin;
    columns.y = task.y;
    if (blocks_ == nullptr) {
      columns.star = Star::star(task, Star::lanes(), neutral_.row(0));
      columns.candidates = Star::count();
      make(columns);
      return;
    }
    Cell* const star_work = columns.work + work_cells();
    while (columns.x < task.columns.end) {
      const CandidateBlocks::Run run = blocks_->run_at(columns.x, task.y, task.columns.end);
      const BlockSegments segments(run.blocks);
      columns.star = stars_->star(task, run, neutral_.row(0), star_work);
      columns.candidates = blocks_->count(run.blocks);
      columns.segment_ends = segments.ends();
      make(columns);
      columns.output += static_cast<std::ptrdiff_t>(run.columns.size()) * Star::lanes();
      columns.x = run.columns.end;
    }
  }

 protected:
  /// Columns of a row that look at the same candidates.
  struct Columns {
    kernels::CellStarRow<Cell> star;
    int x = 0;  ///< of the first one
    int y = 0;
    int candidates = 0;                 ///< in the lanes of each
    std::span<const int> segment_ends;  ///< where runs of neighbouring candidates end; empty: one
    Cell* output = nullptr;             ///< lanes() from column to column, as star.source
    Cell* work = nullptr;               ///< work_cells(), 64-byte aligned
  };

  [[nodiscard]] bool is_start() const { return is_start_; }
  /// That a pixel has on average.
  [[nodiscard]] int candidates() const { return candidates_in(blocks_, Star::count()); }
  /// Segments that the lanes of a column can consist of.
  [[nodiscard]] int most_segments() const { return vantage::most_segments(Star::lanes(), blocks_); }

  /// What make_columns() needs of `work`.
  [[nodiscard]] virtual std::size_t work_cells() const = 0;
  /// Of the start: star.source is star.centre.
  virtual void make_columns(const Columns& columns) const = 0;

 private:
  void make(Columns& columns) const {
    if (is_start_) {
      columns.star.source = columns.star.centre;
    }
    make_columns(columns);
  }

  bool is_start_;
  Image<Cell> neutral_;  ///< stands for the neighbours outside the image
  const CandidateBlocks* blocks_;
  std::optional<BlockStars<Cell>> stars_;  ///< where there are blocks
};

}  // namespace vantage
