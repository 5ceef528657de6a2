#include "engine/matching/selection/stage_fixed_energy_selection.h"

#include <algorithm>
#include <cstddef>

#include "engine/column_work.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;

class EnergySelectionStage final : public scheduler::RowStage {
 public:
  EnergySelectionStage(const kernels::CandidateGeometry& geometry, const EnergySelector& selector,
                       int height, const CandidateBlocks* blocks)
      : RowStage({geometry.width, height}),
        geometry_(geometry),
        selector_(selector),
        blocks_(blocks),
        lanes_(blocks == nullptr ? geometry.lanes() : blocks->lanes()) {}

  [[nodiscard]] std::string_view name() const override { return "energy selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(selector_.work(), candidates_in(blocks_, geometry_.count));
  }

  void make_row(const scheduler::RowTask& task) const override {
    const auto* const cells = task.input.row<FixedEnergy>(task.y);
    EnergySelector::Selected selected;
    for (int x = task.columns.begin; x < task.columns.end;) {
      CandidateBlocks::Run run{{x, std::min(x + EnergySelector::kMaxColumns, task.columns.end)},
                               {}};
      if (blocks_ != nullptr) {
        run = blocks_->run_at(x, task.y, task.columns.end);
      }
      if (!run.is_wanted) {
        x = run.columns.end;
        continue;
      }
      selector_.select(
          geometry_,
          {.cells = cells + static_cast<std::ptrdiff_t>(x - task.input.columns().begin) * lanes_,
           .pitch = lanes_,
           .first = x,
           .count = run.columns.size(),
           .blocks = run.blocks},
          selected);
      selector_.write(selected, x, task.y, run.columns.size());
      x = run.columns.end;
    }
  }

 private:
  kernels::CandidateGeometry geometry_;
  EnergySelector selector_;
  const CandidateBlocks* blocks_;
  int lanes_;  ///< of a column
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_fixed_energy_selection_stage(
    const kernels::CandidateGeometry& geometry, int height, const EnergySelector& selector,
    const CandidateBlocks* blocks) {
  return std::make_unique<EnergySelectionStage>(geometry, selector, height, blocks);
}

}  // namespace vantage
