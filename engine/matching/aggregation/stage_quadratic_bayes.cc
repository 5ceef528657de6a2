#include "engine/matching/aggregation/stage_quadratic_bayes.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "engine/column_work.h"
#include "engine/matching/aggregation/bayes_step_stage.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "kernels/bayes_step/quadratic_step.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage {
namespace {

/// The parts of rows that all stages of a level share.
kernels::QuadraticStepRow quadratic_row(const MethodParameters& parameters,
                                        const AggregationPlace& place, bool smooths) {
  constexpr double kMaxCurvature = 1e20;
  const double sigma = parameters.sigma_prior;
  kernels::QuadraticStepRow row;
  row.curvature =
      static_cast<float>(std::min(double{kernels::kLog2E} / (2 * sigma * sigma), kMaxCurvature));
  row.largest_term = parameters.prior_smoothing == PriorSmoothing::kMaximum;
  row.smooths = smooths;
  row.mu = static_cast<float>(parameters.mu);
  row.count = place.geometry.count;
  row.source_pitch = row.output_pitch = place.geometry.lanes();
  row.plane = place.plane;
  return row;
}

scheduler::ColumnWork work_of(const kernels::QuadraticStepRow& row, bool is_start) {
  return column_work(
      kernels::quadratic_work(row.smooths, row.largest_term, is_start, row.weights.are_given()),
      row.count);
}

class QuadraticBayesStage final : public BayesStepStage<float> {
 public:
  /// iteration: 0: the start.
  QuadraticBayesStage(const kernels::QuadraticStepRow& row, const AggregationPlace& place,
                      int iteration)
      : BayesStepStage(place.geometry, place.height, iteration == 0, 0),
        row_(row),
        edges_(weights_of_iteration(place.edges, iteration)) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return work_of(row_, is_start());
  }
  /// Working memory of the kernel.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) *
           static_cast<std::size_t>(kernels::quadratic_work_floats(lanes(), row_.plane));
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::QuadraticStepRow row = row_;
    row.star = step_star(task);
    if (edges_ != nullptr) {
      row.weights = edges_->star(task.columns.begin, task.y);
    }
    row.output = reinterpret_cast<float*>(task.output);
    row.work = reinterpret_cast<float*>(task.state);
    if (is_start()) {
      kernels::quadratic_start_row(row);
    } else {
      kernels::quadratic_step_row(row);
    }
  }

 private:
  kernels::QuadraticStepRow row_;
  const EdgeWeightPlanes* edges_;
};

/// The state before a level's first iteration, from the final probabilities of the next coarser
/// level.
class QuadraticFromCoarserStage final : public FromCoarserStage<float> {
 public:
  QuadraticFromCoarserStage(const kernels::QuadraticStepRow& row, const AggregationPlace& place)
      : FromCoarserStage(place.geometry, place.height, {place.coarser}, nullptr), row_(row) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override { return work_of(row_, true); }

 protected:
  /// Probabilities and smoothing buffers.
  [[nodiscard]] std::size_t work_cells() const override {
    return kCoarserColumns * static_cast<std::size_t>(lanes()) +
           static_cast<std::size_t>(kernels::quadratic_work_floats(lanes(), row_.plane));
  }

  void make_states(const kernels::CompactRow& coarser, std::span<const int> /*segment_ends*/,
                   float* states, float* work) const override {
    float* const probabilities = work;
    kernels::probabilities_of_compact_row(coarser, probabilities);
    kernels::QuadraticStepRow row = row_;
    row.star.source = probabilities;
    row.star.columns = coarser.columns;
    row.star.lanes = coarser.lanes;
    row.star.centre = row.star.up = row.star.down = probabilities;
    row.star.left_of_first = row.star.right_of_last = probabilities;
    row.output = states;
    row.work = work + kCoarserColumns * static_cast<std::size_t>(lanes());
    kernels::quadratic_start_row(row);
  }

 private:
  kernels::QuadraticStepRow row_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_quadratic_bayes_stages(
    const MethodParameters& parameters, const AggregationPlace& place) {
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    const kernels::QuadraticStepRow row =
        quadratic_row(parameters, place, i < parameters.iterations);
    if (i == 0 && place.coarser != nullptr) {
      stages.push_back(std::make_unique<QuadraticFromCoarserStage>(row, place));
    } else {
      stages.push_back(std::make_unique<QuadraticBayesStage>(row, place, i));
    }
  }
  return stages;
}

}  // namespace vantage
