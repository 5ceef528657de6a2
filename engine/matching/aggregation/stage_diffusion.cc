#include "engine/matching/aggregation/stage_diffusion.h"

#include "engine/column_work.h"
#include "engine/matching/aggregation/star_stage.h"
#include "engine/matching/costs/cost_table.h"
#include "kernels/diffusion_step/diffusion_step.h"
#include "kernels/local_stopping_step/local_stopping_step.h"

namespace vantage {
namespace {

class DiffusionStage final : public StarStage {
 public:
  DiffusionStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
                 int height, const EdgeWeightPlanes* edges)
      : StarStage(geometry, height), step_(static_cast<float>(parameters.lambda)), edges_(edges) {
    if (parameters.aggregation == Aggregation::kMembrane) {
      pull_ = static_cast<float>(parameters.lambda * parameters.beta);
    }
  }

  [[nodiscard]] std::string_view name() const override {
    return pull_ != 0 ? "membrane iteration" : "diffusion iteration";
  }
  [[nodiscard]] bool reads_source() const override { return pull_ != 0; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const bool weighted = edges_ != nullptr;
    return vantage::column_work(
        pull_ != 0 ? kernels::membrane_work(weighted) : kernels::diffusion_work(weighted), count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::DiffusionRow row;
    row.star = star(task, lanes(), nullptr);
    row.step = step_;
    row.pull = pull_;
    if (edges_ != nullptr) {
      row.weights = edges_->star(task.columns.begin, task.y);
    }
    row.output = reinterpret_cast<float*>(task.output);
    kernels::diffusion_row(row);
  }

 private:
  float step_;
  float pull_ = 0;
  const EdgeWeightPlanes* edges_;
};

class LocalStoppingStage final : public StarStage {
 public:
  LocalStoppingStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
                     int height, IterationPlace place, const EdgeWeightPlanes* edges)
      : StarStage(geometry, height),
        step_(static_cast<float>(parameters.lambda)),
        measure_(parameters.certainty == Certainty::kMargin ? kernels::CertaintyMeasure::kMargin
                                                            : kernels::CertaintyMeasure::kEntropy),
        scale_(static_cast<float>(entropy_scale(parameters))),
        edges_(edges),
        input_pitch_(place.is_first ? lanes() : lanes() + kernels::kCertaintyFloats),
        output_pitch_(place.is_last ? lanes() : lanes() + kernels::kCertaintyFloats) {}

  [[nodiscard]] std::string_view name() const override { return "local stopping iteration"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(output_pitch_);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        kernels::local_stopping_work(measure_, input_pitch_ > lanes(), output_pitch_ > lanes(),
                                     edges_ != nullptr),
        count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::LocalStoppingRow row;
    row.star = star(task, input_pitch_, nullptr);
    row.step = step_;
    if (edges_ != nullptr) {
      row.weights = edges_->star(task.columns.begin, task.y);
    }
    row.measure = measure_;
    row.scale = scale_;
    row.count = count();
    row.output = reinterpret_cast<float*>(task.output);
    row.output_pitch = output_pitch_;
    kernels::local_stopping_row(row);
  }

 private:
  float step_;
  kernels::CertaintyMeasure measure_;
  float scale_;
  const EdgeWeightPlanes* edges_;
  int input_pitch_;
  int output_pitch_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_diffusion_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const EdgeWeightPlanes* edges) {
  return std::make_unique<DiffusionStage>(parameters, geometry, height, edges);
}

std::unique_ptr<scheduler::RowStage> make_local_stopping_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    IterationPlace place, const EdgeWeightPlanes* edges) {
  return std::make_unique<LocalStoppingStage>(parameters, geometry, height, place, edges);
}

}  // namespace vantage
