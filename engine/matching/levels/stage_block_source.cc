#include "engine/matching/levels/stage_block_source.h"

#include <cstddef>
#include <cstring>
#include <utility>

#include "kernels/candidates.h"

namespace vantage {
namespace {

using kernels::kLaneMultiple;

class BlockSourceStage final : public scheduler::RowStage {
 public:
  BlockSourceStage(std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks,
                   const CandidateBlocks& blocks)
      : RowStage(of_blocks.front()->extent()),
        of_blocks_(std::move(of_blocks)),
        block_bytes_(of_blocks_.front()->bytes_per_column()),
        blocks_(blocks) {}

  [[nodiscard]] std::string_view name() const override { return of_blocks_.front()->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return block_bytes_ * static_cast<std::size_t>(blocks_.lanes() / kLaneMultiple);
  }
  /// The cells of one block of a run, and the state of its stage.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return cell_bytes() + of_blocks_.front()->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork block = of_blocks_.front()->column_work();
    const double blocks = blocks_.cells_per_pixel() / block.cells;
    return {blocks * block.cells, blocks * block.operations, blocks * block.bytes};
  }

  void make_row(const scheduler::RowTask& task) const override {
    scheduler::RowTask part = task;
    part.output = task.state;
    part.state = task.state + cell_bytes();
    for (int x = task.columns.begin; x < task.columns.end; x = part.columns.end) {
      const CandidateBlocks::Run run = blocks_.run_at(x, task.y, task.columns.end);
      part.columns = run.columns;
      std::byte* target =
          task.output + bytes_per_column() * static_cast<std::size_t>(x - task.columns.begin);
      for (const std::uint16_t block : run.blocks) {
        of_blocks_[block]->make_row(part);
        for (std::size_t j = 0; j < static_cast<std::size_t>(run.columns.size()); ++j) {
          std::memcpy(target + j * bytes_per_column(), task.state + j * block_bytes_, block_bytes_);
        }
        target += block_bytes_;
      }
    }
  }

 private:
  [[nodiscard]] std::size_t cell_bytes() const {
    return block_bytes_ * CandidateBlocks::kMaxRunColumns;
  }

  std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks_;
  std::size_t block_bytes_;  ///< of one block's column
  const CandidateBlocks& blocks_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const CandidateBlocks& blocks) {
  return std::make_unique<BlockSourceStage>(std::move(of_blocks), blocks);
}

}  // namespace vantage
