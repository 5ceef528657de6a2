#include "engine/matching/selection/stage_block_selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/column_work.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/parabola/parabola.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class BlockSelectionStage final : public scheduler::RowStage {
 public:
  BlockSelectionStage(const kernels::CandidateGeometry& geometry, Subpixel subpixel,
                      const MapOutputs& outputs, const CandidateBlocks& blocks)
      : RowStage({geometry.width, outputs.disparity_px.height()}),
        geometry_(geometry),
        subpixel_(subpixel),
        outputs_(outputs),
        blocks_(blocks) {}

  [[nodiscard]] std::string_view name() const override { return "cell selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  /// The cells of some neighbouring candidates of a run, one column behind the other.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(float) * CandidateBlocks::kMostRunColumns *
           static_cast<std::size_t>(blocks_.lanes());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work = kernels::cell_winner_work(true, false) +
                               (subpixel_ == Subpixel::kParabola ? kernels::parabola_work(true)
                                                                 : kernels::kIntegerDisparityWork);
    if (!outputs_.energy.empty()) {
      work = work + kernels::kProbabilityEnergyWork;
    }
    return vantage::column_work(work, candidates_in(&blocks_, geometry_.count));
  }

  void make_row(const scheduler::RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_.run_at(x, task.y, task.columns.end);
      const Choice choice = select(task, run);
      const auto write = [&](const ImageView<float>& view, const Values& values) {
        std::copy_n(values.data(), run.columns.size(), view.row(task.y) + x);
      };
      write(outputs_.disparity_px, choice.disparity_px);
      if (!outputs_.confidence.empty()) {
        write(outputs_.confidence, choice.probability);
      }
      if (!outputs_.energy.empty()) {
        kernels::probability_energy_row(choice.probability.data(), run.columns.size(),
                                        outputs_.energy.row(task.y) + x);
      }
      x = run.columns.end;
    }
  }

 private:
  using Values = std::array<float, CandidateBlocks::kMostRunColumns>;
  /// NaN where there is no candidate.
  struct Choice {
    Values disparity_px;
    Values probability;
  };

  /// Chooses among each run of neighbouring candidates, the smaller ones first, and then the best.
  [[nodiscard]] Choice select(const scheduler::RowTask& task,
                              const CandidateBlocks::Run& run) const {
    Choice best;
    const BlockSegments segments(run.blocks);
    int lane = 0;
    for (const int end : segments.ends()) {
      const Choice choice = select_segment(task, run, {lane, end});
      for (std::size_t j = 0; j < static_cast<std::size_t>(run.columns.size()); ++j) {
        if (lane == 0 || std::isnan(best.probability[j]) ||
            choice.probability[j] > best.probability[j]) {
          best.disparity_px[j] = choice.disparity_px[j];
          best.probability[j] = choice.probability[j];
        }
      }
      lane = end;
    }
    return best;
  }

  [[nodiscard]] Choice select_segment(const scheduler::RowTask& task,
                                      const CandidateBlocks::Run& run, Range lanes) const {
    auto* const packed = reinterpret_cast<float*>(task.state);
    const std::ptrdiff_t pitch = blocks_.lanes();
    const float* const cells = task.input.row<float>(task.y) + lanes.begin +
                               (run.columns.begin - task.input.columns().begin) * pitch;
    for (std::ptrdiff_t j = 0; j < run.columns.size(); ++j) {
      std::copy_n(cells + j * pitch, lanes.size(), packed + j * lanes.size());
    }
    const int first = candidate_of(run.blocks, lanes.begin);
    kernels::CellRow row;
    row.cells = packed;
    row.geometry = geometry_;
    row.geometry.disparity_min += first;
    row.geometry.count = std::min(lanes.size(), geometry_.count - first);
    row.first_column = run.columns.begin;
    row.columns = run.columns.size();
    row.probabilities = true;
    std::array<std::int32_t, CandidateBlocks::kMostRunColumns> winners;
    Choice choice;
    kernels::select_cell_winners_row(
        row, {.winners = winners.data(), .best = choice.probability.data()});
    if (subpixel_ == Subpixel::kParabola) {
      kernels::parabola_disparity_row(row, winners.data(), choice.disparity_px.data());
    } else {
      kernels::integer_disparity_row(row, winners.data(), choice.disparity_px.data());
    }
    return choice;
  }

  kernels::CandidateGeometry geometry_;
  Subpixel subpixel_;
  MapOutputs outputs_;
  const CandidateBlocks& blocks_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_block_selection_stage(
    const kernels::CandidateGeometry& geometry, Subpixel subpixel, const MapOutputs& outputs,
    const CandidateBlocks& blocks) {
  return std::make_unique<BlockSelectionStage>(geometry, subpixel, outputs, blocks);
}

}  // namespace vantage
