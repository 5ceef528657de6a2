#include "engine/matching/aggregation/stage_bayes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "engine/column_work.h"
#include "engine/matching/aggregation/bayes_step_stage.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "kernels/bayes_step/bayes_step.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage {
namespace {

using kernels::BayesState;

// Below this the product of five floors of the prior is not a normal float.
constexpr double kMinEpsilonOfProductForm = 1e-7;
// Taps of the prior this much smaller than its floor are left out: σP = 0.1 needs none besides the
// centre, 0.4 one on each side.
constexpr double kNegligibleTap = 1e-3;

/// Taps (1−ε) exp(−k²/2σ²) of the prior, without negligible ones; an impulse has only the first.
std::vector<float> prior_taps(const MethodParameters& parameters, int count) {
  std::vector<float> taps;
  for (int k = 0; k < count; ++k) {
    const double tap = (1 - parameters.epsilon_prior) *
                       std::exp(-k * k / (2 * parameters.sigma_prior * parameters.sigma_prior));
    const bool is_left_out =
        parameters.prior == Prior::kImpulse || tap < kNegligibleTap * parameters.epsilon_prior;
    if (k > 0 && is_left_out) {
      break;
    }
    taps.push_back(static_cast<float>(tap));
  }
  return taps;
}

/// Radius of one-dimensional smoothing with the same number of operations: two dimensions take two
/// passes.
int radius_of_work(int radius, const kernels::CandidatePlane& plane) {
  return plane.is_given() ? 2 * radius : radius;
}

enum class Form { kStart, kHalf, kGeneral };

/// Value for neighbours outside the image: factors of 1, or their logarithms.
float neutral_state(Form form) { return form == Form::kHalf ? 1 : 0; }

class BayesStage final : public BayesStepStage<float> {
 public:
  /// iteration: 0: the start.
  BayesStage(const MethodParameters& parameters, const AggregationPlace& place, int iteration,
             Form form, BayesState state)
      : BayesStepStage(place.geometry, place.height, form == Form::kStart, neutral_state(form)),
        form_(form),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, place.geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        edges_(weights_of_iteration(place.edges, iteration)),
        plane_(place.plane) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernel_work(), count());
  }
  /// Working memory of the kernel.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) *
           static_cast<std::size_t>(kernels::bayes_work_floats(lanes(), radius(), plane_));
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::BayesRow row;
    row.star = step_star(task);
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    if (edges_ != nullptr) {
      row.weights = edges_->star(task.columns.begin, task.y);
    }
    row.count = count();
    row.plane = plane_;
    row.output = reinterpret_cast<float*>(task.output);
    row.source_pitch = row.output_pitch = lanes();
    row.work = reinterpret_cast<float*>(task.state);
    switch (form_) {
      case Form::kStart:
        kernels::bayes_start_row(row);
        break;
      case Form::kHalf:
        kernels::bayes_half_row(row);
        break;
      case Form::kGeneral:
        kernels::bayes_general_row(row);
        break;
    }
  }

 private:
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }
  [[nodiscard]] kernels::KernelWork kernel_work() const {
    const int radius = radius_of_work(this->radius(), plane_);
    switch (form_) {
      case Form::kStart:
        return kernels::bayes_start_work(state_, radius);
      case Form::kHalf:
        return kernels::bayes_half_work(state_, radius);
      case Form::kGeneral:
        break;
    }
    return kernels::bayes_general_work(state_, radius, kernels::bayes_scales_sums(mu_, floor_),
                                       edges_ != nullptr);
  }

  Form form_;
  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  const EdgeWeightPlanes* edges_;
  kernels::CandidatePlane plane_;
};

/// The state before a level's first iteration, from the final probabilities of the next coarser
/// level.
class BayesFromCoarserStage final : public FromCoarserStage<float> {
 public:
  BayesFromCoarserStage(const MethodParameters& parameters, const AggregationPlace& place,
                        BayesState state)
      : FromCoarserStage(place.geometry, place.height, {place.coarser}, nullptr),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, place.geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        plane_(place.plane) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        kernels::bayes_start_from_coarser_work(state_, radius_of_work(radius(), plane_)),
        candidates());
  }

 protected:
  /// Probabilities and smoothing buffers.
  [[nodiscard]] std::size_t work_cells() const override {
    return kCoarserColumns * static_cast<std::size_t>(lanes()) +
           static_cast<std::size_t>(kernels::bayes_work_floats(lanes(), radius(), plane_));
  }

  void make_states(const kernels::CompactRow& coarser, std::span<const int> /*segment_ends*/,
                   float* states, float* work) const override {
    float* const probabilities = work;
    kernels::probabilities_of_compact_row(coarser, probabilities);
    kernels::BayesRow row;
    row.star.centre = row.star.up = row.star.down = row.star.source = probabilities;
    row.star.left_of_first = row.star.right_of_last = probabilities;
    row.star.columns = coarser.columns;
    row.star.lanes = coarser.lanes;
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    row.count = coarser.count;
    row.output = states;
    row.source_pitch = row.output_pitch = coarser.lanes;
    row.plane = plane_;
    row.work = work + kCoarserColumns * static_cast<std::size_t>(lanes());
    kernels::bayes_start_row(row);
  }

 private:
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }

  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  kernels::CandidatePlane plane_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const AggregationPlace& place) {
  const bool half = parameters.mu == 0.5 && place.edges == nullptr &&
                    parameters.epsilon_prior >= kMinEpsilonOfProductForm;
  const BayesState between = half ? BayesState::kSmoothed : BayesState::kLogSmoothed;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    const Form form = i == 0 ? Form::kStart : half ? Form::kHalf : Form::kGeneral;
    const BayesState state = i == parameters.iterations ? BayesState::kProbability : between;
    if (i == 0 && place.coarser != nullptr) {
      stages.push_back(std::make_unique<BayesFromCoarserStage>(parameters, place, state));
    } else {
      stages.push_back(std::make_unique<BayesStage>(parameters, place, i, form, state));
    }
  }
  return stages;
}

}  // namespace vantage
