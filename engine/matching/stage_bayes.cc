#include "engine/matching/stage_bayes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/image/image.h"
#include "engine/matching/column_work.h"
#include "engine/matching/star_stage.h"
#include "kernels/bayes_step/bayes_step.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage {
namespace {

using kernels::BayesState;

// Below this the product of five floors of the prior is no normal float.
constexpr double kLeastEpsilonOfProductForm = 1e-7;
// Taps of the prior this much smaller than its floor are left out: σP = 0.1 needs none beside the
// centre, 0.4 one on each side.
constexpr double kNegligibleTap = 1e-3;

/// Taps (1−ε) exp(−k²/2σ²) of the prior, as many as matter.
std::vector<float> prior_taps(const MethodParameters& parameters, int count) {
  std::vector<float> taps;
  for (int k = 0; k < count; ++k) {
    const double tap = (1 - parameters.epsilon_prior) *
                       std::exp(-k * k / (2 * parameters.sigma_prior * parameters.sigma_prior));
    if (k > 0 && tap < kNegligibleTap * parameters.epsilon_prior) {
      break;
    }
    taps.push_back(static_cast<float>(tap));
  }
  return taps;
}

enum class Form { kStart, kHalf, kGeneral };

class BayesStage final : public StarStage {
 public:
  BayesStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
             int height, Form form, BayesState state)
      : StarStage(geometry, height),
        form_(form),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        neutral_(lanes(), 1) {
    neutral_.fill(form == Form::kHalf ? 1.0F : 0.0F);
  }

  [[nodiscard]] std::string_view name() const override {
    return form_ == Form::kStart ? "Bayes start" : "Bayes iteration";
  }
  [[nodiscard]] bool reads_source() const override { return form_ != Form::kStart; }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return form_ == Form::kStart ? RowStage::input_rows(y, input) : StarStage::input_rows(y, input);
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return form_ == Form::kStart ? RowStage::input_columns(columns, input)
                                 : StarStage::input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return form_ == Form::kStart ? 1 : 3; }
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) * static_cast<std::size_t>(kernels::bayes_work_floats(lanes(), radius()));
  }

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernel_work(), count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::BayesRow row;
    row.star = star(task, lanes(), neutral_.row(0));
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    row.count = count();
    row.output = reinterpret_cast<float*>(task.output);
    row.work = reinterpret_cast<float*>(task.state);
    switch (form_) {
      case Form::kStart:
        row.star.source = row.star.centre;
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
    switch (form_) {
      case Form::kStart:
        return kernels::bayes_start_work(state_, radius());
      case Form::kHalf:
        return kernels::bayes_half_work(state_, radius());
      case Form::kGeneral:
        break;
    }
    return kernels::bayes_general_work(state_, radius(), kernels::bayes_scales_sums(mu_, floor_));
  }

  Form form_;
  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  Image<float> neutral_;  ///< stands for the neighbours outside the image
};

/// The state before the first iteration of a level, from the probabilities that the next coarser
/// one ended with: column x of row y lies in column x/2 of row y/2 there. Takes part in the chain
/// like the start from likelihoods, so that iterations find their source, but looks at no input.
class BayesFromCoarserStage final : public scheduler::RowStage {
 public:
  BayesFromCoarserStage(const MethodParameters& parameters,
                        const kernels::CandidateGeometry& geometry, int height, BayesState state,
                        const LevelVolume& coarser)
      : RowStage({geometry.width, height}),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        coarser_(coarser) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * lanes(); }
  /// Of one block: probabilities and states of coarser columns, and what smoothing needs.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) * (2 * kBlockColumns * lanes() +
                            static_cast<std::size_t>(kernels::bayes_work_floats(lanes_, radius())));
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::bayes_start_from_coarser_work(state_, radius()), count_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* const output = reinterpret_cast<float*>(task.output);
    if (task.y % 2 == 1 && task.previous != nullptr) {
      // Both rows are the same one of the coarser level.
      if (task.previous != task.output) {
        std::memcpy(task.output, task.previous,
                    bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
      }
      return;
    }
    auto* const probabilities = reinterpret_cast<float*>(task.state);
    float* const states = probabilities + kBlockColumns * lanes();
    const int end = (task.columns.end + 1) / 2;
    for (int first = task.columns.begin / 2; first < end; first += kBlockColumns) {
      const int columns = std::min(kBlockColumns, end - first);
      make_states(task.y / 2, first, columns, probabilities, states);
      for (int x = std::max(2 * first, task.columns.begin);
           x < std::min(2 * (first + columns), task.columns.end); ++x) {
        std::copy_n(states + lanes() * static_cast<std::size_t>(x / 2 - first), lanes(),
                    output + lanes() * static_cast<std::size_t>(x - task.columns.begin));
      }
    }
  }

 private:
  static constexpr int kBlockColumns = 8;

  [[nodiscard]] std::size_t lanes() const { return static_cast<std::size_t>(lanes_); }
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }

  /// Of columns of the coarser level. Behind `states` lies the kernel's working memory.
  void make_states(int coarser_row, int first, int columns, float* probabilities,
                   float* states) const {
    kernels::probabilities_of_compact_row(
        {.cells = coarser_.column<std::uint8_t>(first, coarser_row),
         .columns = columns,
         .lanes = lanes_,
         .count = count_},
        probabilities);
    kernels::BayesRow row;
    row.star.centre = row.star.up = row.star.down = row.star.source = probabilities;
    row.star.left_of_first = row.star.right_of_last = probabilities;
    row.star.columns = columns;
    row.star.lanes = lanes_;
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    row.count = count_;
    row.output = states;
    row.work = states + kBlockColumns * lanes();
    kernels::bayes_start_row(row);
  }

  int lanes_;
  int count_;
  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  const LevelVolume& coarser_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const LevelVolume* coarser) {
  const bool half = parameters.mu == 0.5 && parameters.epsilon_prior >= kLeastEpsilonOfProductForm;
  const BayesState between = half ? BayesState::kSmoothed : BayesState::kLogSmoothed;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    const Form form = i == 0 ? Form::kStart : half ? Form::kHalf : Form::kGeneral;
    const BayesState state = i == parameters.iterations ? BayesState::kProbability : between;
    if (i == 0 && coarser != nullptr) {
      stages.push_back(
          std::make_unique<BayesFromCoarserStage>(parameters, geometry, height, state, *coarser));
      continue;
    }
    stages.push_back(std::make_unique<BayesStage>(parameters, geometry, height, form, state));
  }
  return stages;
}

}  // namespace vantage
