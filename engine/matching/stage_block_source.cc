#include "engine/matching/stage_block_source.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kernels/candidates.h"

namespace vantage {
namespace {

using kernels::kLaneMultiple;

class BlockSourceStage final : public scheduler::RowStage {
 public:
  BlockSourceStage(std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks,
                   const CandidateBlocks& blocks)
      : RowStage(of_blocks.front()->extent()), of_blocks_(std::move(of_blocks)), blocks_(blocks) {}

  [[nodiscard]] std::string_view name() const override { return of_blocks_.front()->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * lanes(); }
  /// The cells of one block of a run, and what its stage needs.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return kCellBytes + of_blocks_.front()->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork block = of_blocks_.front()->column_work();
    const double blocks = blocks_.cells_per_pixel() / block.cells;
    return {blocks * block.cells, blocks * block.operations, blocks * block.bytes};
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* const output = reinterpret_cast<float*>(task.output);
    auto* const cells = reinterpret_cast<float*>(task.state);
    scheduler::RowTask part = task;
    part.output = task.state;
    part.state = task.state + kCellBytes;
    for (int x = task.columns.begin; x < task.columns.end; x = part.columns.end) {
      const CandidateBlocks::Run run = blocks_.run_at(x, task.y, task.columns.end);
      part.columns = run.columns;
      float* target = output + lanes() * static_cast<std::size_t>(x - task.columns.begin);
      for (const std::uint16_t block : run.blocks) {
        of_blocks_[block]->make_row(part);
        for (int j = 0; j < run.columns.size(); ++j) {
          std::copy_n(cells + static_cast<std::ptrdiff_t>(j) * kLaneMultiple, kLaneMultiple,
                      target + lanes() * static_cast<std::size_t>(j));
        }
        target += kLaneMultiple;
      }
    }
  }

 private:
  static constexpr std::size_t kCellBytes =
      sizeof(float) * std::size_t{kLaneMultiple} * CandidateBlocks::kMostRunColumns;

  [[nodiscard]] std::size_t lanes() const { return static_cast<std::size_t>(blocks_.lanes()); }

  std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks_;
  const CandidateBlocks& blocks_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const CandidateBlocks& blocks) {
  return std::make_unique<BlockSourceStage>(std::move(of_blocks), blocks);
}

}  // namespace vantage
