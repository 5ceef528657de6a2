#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "engine/matching/levels/level_extents.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/block_row.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Rows of `finer` whose 2×2 blocks are the columns of row y of the next coarser level.
template <typename Cell>
kernels::BlockRow<Cell> block_row(const LevelVolume& finer, int y) {
  return {.upper = finer.column<Cell>(0, 2 * y),
          .lower = finer.column<Cell>(0, std::min(2 * y + 1, finer.extent().rows - 1)),
          .columns = finer.extent().columns,
          .lanes = finer.lanes()};
}

/// Common base of last stages that make the volume of the next coarser level. Input cells:
/// geometry.lanes() per column.
class LevelReductionStage : public scheduler::RowStage {
 public:
  LevelReductionStage(const kernels::CandidateGeometry& geometry, LevelVolume& coarser)
      : RowStage(coarser.extent()),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        coarser_(coarser) {}

  [[nodiscard]] std::string_view name() const override { return "reduce"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return {2 * y, std::min(2 * y + 2, input.rows)};
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return {2 * columns.begin, std::min(2 * columns.end, input.columns)};
  }
  [[nodiscard]] int window_rows() const override { return 2; }

 protected:
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] LevelVolume& coarser() const { return coarser_; }

  /// The blocks of a task.
  template <typename Cell>
  [[nodiscard]] kernels::BlockRow<Cell> blocks(const scheduler::RowTask& task) const {
    const int first = 2 * task.columns.begin;
    const auto row = [&](int y) {
      return task.input.row<Cell>(y) +
             static_cast<std::ptrdiff_t>(first - task.input.columns().begin) * lanes_;
    };
    return {.upper = row(2 * task.y),
            .lower = row(std::min(2 * task.y + 1, task.input.rows().end - 1)),
            .columns = std::min(2 * task.columns.end, task.input.columns().end) - first,
            .lanes = lanes_};
  }

 private:
  int lanes_;
  int count_;
  LevelVolume& coarser_;
};

/// Last stage that stores the cells of a level in a volume: consecutive columns with the same
/// number of lanes.
class LevelStoreStage : public scheduler::RowStage {
 public:
  LevelStoreStage(const kernels::CandidateGeometry& geometry, LevelVolume& volume)
      : RowStage(volume.extent()),
        lanes_(volume.lanes()),
        count_(geometry.count),
        volume_(volume) {}

  [[nodiscard]] std::string_view name() const override { return "store level"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }

 protected:
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] LevelVolume& volume() const { return volume_; }
  /// From column x on.
  template <typename Cell>
  [[nodiscard]] const Cell* cells(const scheduler::RowTask& task, int x) const {
    return task.input.row<Cell>(task.y) +
           static_cast<std::ptrdiff_t>(x - task.input.columns().begin) * lanes_;
  }
  [[nodiscard]] int cell_count(const scheduler::RowTask& task) const {
    return task.columns.size() * lanes_;
  }

 private:
  int lanes_;
  int count_;
  LevelVolume& volume_;
};

/// Source stage that reads cells from a volume; float unless stated otherwise.
class LevelSourceStage : public scheduler::RowStage {
 public:
  LevelSourceStage(const kernels::CandidateGeometry& geometry, const LevelVolume& volume)
      : RowStage(volume.extent()),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        volume_(volume) {}

  [[nodiscard]] std::string_view name() const override { return "stored level"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(lanes_);
  }

 protected:
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] const LevelVolume& volume() const { return volume_; }

 private:
  int lanes_;
  int count_;
  const LevelVolume& volume_;
};

}  // namespace vantage
