#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <vector>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Result of the next coarser level, one byte per cell, large for unlikely candidates.
struct CoarserResult {
  const LevelVolume* volume = nullptr;  ///< null: no coarser level
  /// The candidates processed there, whose lanes the cells occupy; null: all.
  const CandidateBlocks* blocks = nullptr;
};

/// Reads columns of the next coarser level.
class CoarserColumns {
 public:
  /// `lanes`: of all candidates.
  CoarserColumns(const CoarserResult& coarser, int lanes)
      : coarser_(coarser), all_blocks_(static_cast<std::size_t>(lanes / kernels::kLaneMultiple)) {
    std::iota(all_blocks_.begin(), all_blocks_.end(), std::uint16_t{0});
  }

  [[nodiscard]] BlockList all_blocks() const { return all_blocks_; }
  /// The bytes of `columns` of row y, rearranged to the lanes of `blocks`; candidates that were not
  /// processed there are kMaxCompact.
  void fetch(int y, BlockList blocks, scheduler::Range columns, std::uint8_t* bytes) const {
    for (int x = columns.begin; x < columns.end;) {
      const CandidateBlocks::Run own = coarser_.blocks == nullptr
                                           ? CandidateBlocks::Run{{x, columns.end}, all_blocks_}
                                           : coarser_.blocks->run_at(x, y, columns.end);
      for (; x < own.columns.end; ++x) {
        copy_blocks<std::uint8_t>(coarser_.volume->column<std::uint8_t>(x, y), own.blocks, blocks,
                                  kernels::kMaxCompact, bytes);
        bytes += blocks.size() * kernels::kLaneMultiple;
      }
    }
  }

 private:
  CoarserResult coarser_;
  std::vector<std::uint16_t> all_blocks_;
};

/// A geometry whose candidates are the cells of a column.
inline kernels::CandidateGeometry cell_geometry(const kernels::CandidateGeometry& geometry,
                                                const CandidateBlocks* blocks) {
  kernels::CandidateGeometry cells = geometry;
  if (blocks != nullptr) {
    cells.count = blocks->lanes();
  }
  return cells;
}

/// Maximum number of runs of consecutive candidates in columns of `lanes` lanes.
inline int max_segments(int lanes, const CandidateBlocks* blocks) {
  return blocks == nullptr ? 1 : lanes / kernels::kLaneMultiple;
}

/// The state before a level's first iteration, from the result of the next coarser level: column x
/// of row y reads column x/2 of row y/2 there. It takes the place of the start from likelihoods in
/// the chain, so that iterations find their source, but reads no input. `blocks`: the candidates
/// processed, whose lanes the cells occupy; null: all. Volumes and blocks must outlive the stage.
template <typename Cell>
class FromCoarserStage : public scheduler::RowStage {
 public:
  FromCoarserStage(const kernels::CandidateGeometry& geometry, int height,
                   const CoarserResult& coarser, const CandidateBlocks* blocks)
      : RowStage({geometry.width, height}),
        lanes_(cell_geometry(geometry, blocks).lanes()),
        count_(geometry.count),
        coarser_(coarser, geometry.lanes()),
        blocks_(blocks) {}

  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(Cell) * static_cast<std::size_t>(lanes_);
  }
  /// For a few coarser columns: states, working memory for making them, and their bytes.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return kCoarserColumns * bytes_per_column() + sizeof(Cell) * work_cells() +
           kCoarserColumns * static_cast<std::size_t>(lanes_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    if (task.y % 2 == 1 && task.previous != nullptr) {
      // Both rows come from the same coarser row.
      if (task.previous != task.output) {
        copy_row(task);
      }
      return;
    }
    if (blocks_ == nullptr) {
      make_columns(task, {task.columns, coarser_.all_blocks()}, count_);
      return;
    }
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      if (!run.blocks.empty()) {
        make_columns(task, run, blocks_->count(run.blocks));
      }
      x = run.columns.end;
    }
  }

 protected:
  static constexpr int kCoarserColumns = 8;

  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] const CandidateBlocks* blocks() const { return blocks_; }
  /// Mean per pixel.
  [[nodiscard]] int candidates() const { return candidates_in(blocks_, count_); }

  /// Cells of `work` in make_states().
  [[nodiscard]] virtual std::size_t work_cells() const = 0;
  /// States of at most kCoarserColumns columns, contiguous. segment_ends: ends of runs of lanes
  /// with consecutive candidates.
  virtual void make_states(const kernels::CompactRow& coarser, std::span<const int> segment_ends,
                           Cell* states, Cell* work) const = 0;

 private:
  /// count: candidates in the lanes of the run.
  void make_columns(const scheduler::RowTask& task, const CandidateBlocks::Run& run,
                    int count) const {
    const std::size_t run_lanes = run.blocks.size() * kernels::kLaneMultiple;
    auto* const output = reinterpret_cast<Cell*>(task.output);
    auto* const states = reinterpret_cast<Cell*>(task.state);
    Cell* const work = states + kCoarserColumns * lanes_;
    auto* const bytes = reinterpret_cast<std::uint8_t*>(work + work_cells());
    const BlockSegments segments(run.blocks);
    const int end = (run.columns.end + 1) / 2;
    for (int first = run.columns.begin / 2; first < end; first += kCoarserColumns) {
      const int columns = std::min(kCoarserColumns, end - first);
      coarser_.fetch(task.y / 2, run.blocks, {first, first + columns}, bytes);
      make_states({.cells = bytes,
                   .columns = columns,
                   .lanes = static_cast<int>(run_lanes),
                   .count = count},
                  segments.ends(), states, work);
      for (int x = std::max(2 * first, run.columns.begin);
           x < std::min(2 * (first + columns), run.columns.end); ++x) {
        copy_lanes(states + run_lanes * static_cast<std::size_t>(x / 2 - first), run_lanes,
                   output + static_cast<std::size_t>(lanes_) *
                                static_cast<std::size_t>(x - task.columns.begin));
      }
    }
  }

  /// The row made before, of each column the lanes in use.
  void copy_row(const scheduler::RowTask& task) const {
    if (blocks_ == nullptr) {
      std::memcpy(task.output, task.previous,
                  bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
      return;
    }
    const auto* from = reinterpret_cast<const Cell*>(task.previous);
    auto* to = reinterpret_cast<Cell*>(task.output);
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      for (; x < run.columns.end; ++x, from += lanes_, to += lanes_) {
        copy_lanes(from, run.blocks.size() * kernels::kLaneMultiple, to);
      }
    }
  }

  /// In parts whose size the compiler knows: columns are short.
  static void copy_lanes(const Cell* from, std::size_t lanes, Cell* to) {
    for (std::size_t lane = 0; lane < lanes; lane += kernels::kLaneMultiple) {
      std::copy_n(from + lane, kernels::kLaneMultiple, to + lane);
    }
  }

  int lanes_;
  int count_;
  CoarserColumns coarser_;
  const CandidateBlocks* blocks_;
};

}  // namespace vantage
