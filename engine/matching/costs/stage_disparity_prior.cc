#include "engine/matching/costs/stage_disparity_prior.h"

#include <utility>

#include "engine/column_work.h"
#include "kernels/disparity_prior/disparity_prior.h"

namespace vantage {
namespace {

class DisparityPriorStage final : public scheduler::RowStage {
 public:
  DisparityPriorStage(std::unique_ptr<scheduler::RowStage> costs,
                      const kernels::CandidateGeometry& geometry, CellMeaning meaning,
                      const PriorPull& pull)
      : RowStage(costs->extent()),
        costs_(std::move(costs)),
        geometry_(geometry),
        meaning_(meaning),
        pull_(pull) {}

  [[nodiscard]] std::string_view name() const override { return "cost with prior"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return costs_->bytes_per_column(); }
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return costs_->state_bytes(columns, input);
  }
  /// Assumes that every pixel has a prior.
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork prior =
        vantage::column_work(meaning_ == CellMeaning::kEnergy ? kernels::kEnergiesWithPriorWork
                                                              : kernels::kLikelihoodsWithPriorWork,
                             static_cast<int>(costs_->column_work().cells));
    scheduler::ColumnWork work = costs_->column_work();
    work.operations += prior.operations;
    work.bytes += prior.bytes;
    return work;
  }

  void make_row(const scheduler::RowTask& task) const override {
    costs_->make_row(task);
    const kernels::DisparityPriorRow row{
        .prior_px = pull_.prior_px.row(task.y) + task.columns.begin,
        .columns = task.columns.size(),
        .lanes = static_cast<int>(bytes_per_column() / sizeof(float)),
        .count = geometry_.count,
        .disparity_min = geometry_.disparity_min,
        .steps_per_px = geometry_.steps_per_px,
        .first_candidate = pull_.first_candidate,
        .weight = pull_.weight,
        .max_contrast = pull_.max_contrast,
    };
    auto* cells = reinterpret_cast<float*>(task.output);
    if (meaning_ == CellMeaning::kEnergy) {
      kernels::energies_with_prior_row(row, cells);
    } else {
      kernels::likelihoods_with_prior_row(row, cells);
    }
  }

 private:
  std::unique_ptr<scheduler::RowStage> costs_;
  kernels::CandidateGeometry geometry_;
  CellMeaning meaning_;
  PriorPull pull_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_disparity_prior_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    CellMeaning meaning, const PriorPull& pull) {
  return std::make_unique<DisparityPriorStage>(std::move(costs), geometry, meaning, pull);
}

}  // namespace vantage
