#include "engine/matching/costs/stage_displacement_cost.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "engine/column_work.h"
#include "engine/matching/costs/partnered_candidates.h"
#include "kernels/evidence/evidence.h"
#include "kernels/pixel_cost/pixel_cost.h"

namespace vantage {
namespace {

/// Rounds up, so that the state that follows starts at a cache line.
std::size_t whole_cache_lines(std::size_t bytes) {
  constexpr std::size_t kLineBytes = 64;
  return (bytes + kLineBytes - 1) / kLineBytes * kLineBytes;
}

class DisplacementCostStage final : public scheduler::RowStage {
 public:
  DisplacementCostStage(std::vector<std::unique_ptr<scheduler::RowStage>> of_rows,
                        const DisplacementGrid& grid, unsigned char padding)
      : RowStage(of_rows.front()->extent()),
        of_rows_(std::move(of_rows)),
        row_bytes_(of_rows_.front()->bytes_per_column()),
        cell_bytes_(row_bytes_ / static_cast<std::size_t>(grid.along_rows.lanes())),
        row_candidates_(static_cast<std::size_t>(grid.along_rows.count)),
        count_(static_cast<std::size_t>(grid.count())),
        lanes_(static_cast<std::size_t>(grid.columns().lanes())),
        padding_(padding) {}

  [[nodiscard]] std::string_view name() const override { return of_rows_.front()->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override { return lanes_ * cell_bytes_; }
  /// Cells of a few columns at one vertical disparity, and the state of their stage.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return part_bytes() + of_rows_.front()->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork row = of_rows_.front()->column_work();
    const auto rows = static_cast<double>(of_rows_.size());
    return {rows * row.cells, rows * row.operations, rows * row.bytes};
  }

  void make_row(const scheduler::RowTask& task) const override {
    scheduler::RowTask part = task;
    part.output = task.state;
    part.state = task.state + part_bytes();
    for (int x = task.columns.begin; x < task.columns.end; x = part.columns.end) {
      part.columns = {x, std::min(x + kBlockColumns, task.columns.end)};
      std::byte* const first =
          task.output + bytes_per_column() * static_cast<std::size_t>(x - task.columns.begin);
      const std::size_t run_bytes = row_candidates_ * cell_bytes_;
      for (std::size_t row = 0; row < of_rows_.size(); ++row) {
        of_rows_[row]->make_row(part);
        for (std::size_t j = 0; j < static_cast<std::size_t>(part.columns.size()); ++j) {
          std::memcpy(first + j * bytes_per_column() + row * run_bytes,
                      part.output + j * row_bytes_, run_bytes);
        }
      }
      for (std::size_t j = 0; j < static_cast<std::size_t>(part.columns.size()); ++j) {
        std::memset(first + j * bytes_per_column() + count_ * cell_bytes_, padding_,
                    (lanes_ - count_) * cell_bytes_);
      }
    }
  }

 private:
  /// Columns computed at a time: few enough for the L1 cache.
  static constexpr int kBlockColumns = 32;

  [[nodiscard]] std::size_t part_bytes() const {
    return whole_cache_lines(row_bytes_ * kBlockColumns);
  }

  std::vector<std::unique_ptr<scheduler::RowStage>> of_rows_;
  std::size_t row_bytes_;  ///< per column at one vertical disparity
  std::size_t cell_bytes_;
  std::size_t row_candidates_;
  std::size_t count_;
  std::size_t lanes_;
  unsigned char padding_;
};

class DisplacementEvidenceStage final : public scheduler::RowStage {
 public:
  DisplacementEvidenceStage(std::unique_ptr<scheduler::RowStage> evidence,
                            const DisplacementGrid& grid, const MethodParameters& parameters)
      : RowStage(evidence->extent()),
        evidence_(std::move(evidence)),
        grid_(grid),
        lanes_(grid.columns().lanes()),
        sigma_(
            static_cast<float>(std::max(kernels::kMinEvidenceSigma, parameters.sigma_measurement))),
        epsilon_(kernels::ContaminatedGaussian::of(parameters.sigma_measurement,
                                                   parameters.epsilon_measurement)
                     .epsilon) {}

  [[nodiscard]] std::string_view name() const override { return evidence_->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return evidence_->bytes_per_column();
  }
  /// One column, and the state of the evidence stage.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return packed_bytes() + evidence_->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    scheduler::ColumnWork work = evidence_->column_work();
    const scheduler::ColumnWork own =
        vantage::column_work(kernels::kLikelihoodOfEvidenceWork, grid_.count());
    work.operations += own.operations;
    work.bytes += own.bytes;
    return work;
  }

  void make_row(const scheduler::RowTask& task) const override {
    scheduler::RowTask part = task;
    part.state = task.state + packed_bytes();
    evidence_->make_row(part);
    auto* cells = reinterpret_cast<float*>(task.output);
    auto* const packed = reinterpret_cast<float*>(task.state);
    for (int x = task.columns.begin; x < task.columns.end; ++x, cells += lanes_) {
      const PartneredCandidates inside{grid_.along_rows.with_partner(x),
                                       grid_.rows_with_partner(task.y)};
      if (inside.are_all(grid_)) {
        make_likelihoods(grid_.count(), cells);
        continue;
      }
      inside.each_run(grid_, cells, packed, [](const float* from, float* to, int count) {
        std::copy_n(from, count, to);
      });
      if (!inside.empty()) {
        make_likelihoods(inside.count(), packed);
      }
      std::fill_n(cells, grid_.count(), epsilon_);
      inside.each_run(grid_, cells, packed, [](float* to, const float* from, int count) {
        std::copy_n(from, count, to);
      });
    }
  }

 private:
  [[nodiscard]] std::size_t packed_bytes() const {
    return whole_cache_lines(sizeof(float) * static_cast<std::size_t>(lanes_));
  }
  void make_likelihoods(int count, float* cells) const {
    kernels::likelihood_of_evidence({all_partnered(count, 1), first_partnered_column(count), 1},
                                    sigma_, epsilon_, cells);
  }

  std::unique_ptr<scheduler::RowStage> evidence_;
  DisplacementGrid grid_;
  int lanes_;
  float sigma_;
  float epsilon_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_displacement_cost_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_rows, const DisplacementGrid& grid,
    unsigned char padding) {
  return std::make_unique<DisplacementCostStage>(std::move(of_rows), grid, padding);
}

std::unique_ptr<scheduler::RowStage> make_displacement_evidence_stage(
    std::unique_ptr<scheduler::RowStage> evidence, const DisplacementGrid& grid,
    const MethodParameters& parameters) {
  return std::make_unique<DisplacementEvidenceStage>(std::move(evidence), grid, parameters);
}

}  // namespace vantage
