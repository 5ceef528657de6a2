#include "engine/matching/levels/stage_block_source.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/column_work.h"
#include "kernels/candidates.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using kernels::kLaneMultiple;

class BlockSourceStage final : public scheduler::RowStage {
 public:
  BlockSourceStage(std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks,
                   const EnergyConversion& conversion, int count, const CandidateBlocks& blocks)
      : RowStage(of_blocks.front()->extent()),
        of_blocks_(std::move(of_blocks)),
        conversion_(conversion),
        count_(count),
        blocks_(blocks) {}

  [[nodiscard]] std::string_view name() const override { return of_blocks_.front()->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(FixedEnergy) * static_cast<std::size_t>(blocks_.lanes());
  }
  /// The costs of one block of a run, and the state of its stage.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return cost_bytes() + of_blocks_.front()->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork costs = of_blocks_.front()->column_work();
    const double candidates = blocks_.cells_per_pixel();
    const double blocks = candidates / costs.cells;
    const scheduler::ColumnWork own =
        vantage::column_work(conversion_.work(), candidates_in(&blocks_, count_));
    return {candidates, blocks * costs.operations + own.operations,
            blocks * costs.bytes + own.bytes};
  }

  void make_row(const scheduler::RowTask& task) const override {
    scheduler::RowTask part = task;
    part.output = task.state;
    part.state = task.state + cost_bytes();
    auto* energies = reinterpret_cast<FixedEnergy*>(task.output);
    for (int x = task.columns.begin; x < task.columns.end; x = part.columns.end) {
      const CandidateBlocks::Run run = blocks_.run_at(x, task.y, task.columns.end);
      part.columns = run.columns;
      FixedEnergy* target = energies;
      for (const std::uint16_t block : run.is_wanted ? run.blocks : BlockList()) {
        of_blocks_[block]->make_row(part);
        conversion_.convert(part.output, run.columns.size(), kLaneMultiple,
                            std::min(kLaneMultiple, count_ - block * kLaneMultiple), target,
                            blocks_.lanes());
        target += kLaneMultiple;
      }
      energies += static_cast<std::ptrdiff_t>(run.columns.size()) * blocks_.lanes();
    }
  }

 private:
  /// A multiple of 64, as kLaneMultiple divides a block's bytes.
  [[nodiscard]] std::size_t cost_bytes() const {
    return of_blocks_.front()->bytes_per_column() * CandidateBlocks::kMaxRunColumns;
  }

  std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks_;
  EnergyConversion conversion_;
  int count_;
  const CandidateBlocks& blocks_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const EnergyConversion& conversion,
    int count, const CandidateBlocks& blocks) {
  return std::make_unique<BlockSourceStage>(std::move(of_blocks), conversion, count, blocks);
}

}  // namespace vantage
