#include "engine/matching/stage_bayes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "engine/image/image.h"
#include "engine/matching/block_star.h"
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

/// Working memory of a kernel on columns of so many lanes, of blocks that need not be neighbours.
std::size_t work_floats(int lanes, int radius, const CandidateBlocks* blocks) {
  const int segments = blocks == nullptr ? 1 : lanes / kernels::kLaneMultiple;
  return static_cast<std::size_t>(kernels::bayes_work_floats(lanes, radius, segments));
}

/// What neighbours have in place of candidates that were not looked at: the state of p = 0.
float absent_state(BayesState state, float mu, float floor) {
  return state == BayesState::kLogSmoothed ? mu * std::log2(floor) : floor;
}

class BayesStage final : public StarStage {
 public:
  BayesStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
             int height, Form form, BayesState state, const EdgeWeights* edges,
             const CandidateBlocks* blocks)
      : StarStage(cell_geometry(geometry, blocks), height),
        form_(form),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        edges_(edges),
        neutral_(lanes(), 1),
        blocks_(blocks) {
    neutral_.fill(form == Form::kHalf ? 1.0F : 0.0F);
    if (blocks != nullptr) {
      const BayesState of_input =
          form == Form::kHalf ? BayesState::kSmoothed : BayesState::kLogSmoothed;
      stars_.emplace(*blocks, absent_state(of_input, mu_, floor_));
    }
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
    return sizeof(float) *
           (work_floats(lanes(), radius(), blocks_) + (stars_ ? stars_->work_cells() : 0));
  }

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernel_work(), candidates_in(blocks_, count()));
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::BayesRow row;
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    row.output = reinterpret_cast<float*>(task.output);
    row.source_pitch = row.output_pitch = lanes();
    row.work = reinterpret_cast<float*>(task.state);
    if (blocks_ == nullptr) {
      row.star = star(task, lanes(), neutral_.row(0));
      row.weights = weights(task.columns.begin, task.y);
      row.count = count();
      make_columns(row);
      return;
    }
    float* const star_work = row.work + work_floats(lanes(), radius(), blocks_);
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      const BlockSegments segments(run.blocks);
      row.star = stars_->star(task, run, neutral_.row(0), star_work);
      row.weights = weights(x, task.y);
      row.count = blocks_->count(run.blocks);
      row.segment_ends = segments.ends();
      make_columns(row);
      row.output += run.columns.size() * row.output_pitch;
      x = run.columns.end;
    }
  }

 private:
  void make_columns(kernels::BayesRow& row) const {
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
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }
  /// From column x on.
  [[nodiscard]] kernels::StarWeights weights(int x, int y) const {
    if (edges_ == nullptr) {
      return {};
    }
    return {.beside = edges_->beside(y) + x,
            .above = edges_->above(y) + x,
            .below = edges_->above(y + 1) + x};
  }
  [[nodiscard]] kernels::KernelWork kernel_work() const {
    switch (form_) {
      case Form::kStart:
        return kernels::bayes_start_work(state_, radius());
      case Form::kHalf:
        return kernels::bayes_half_work(state_, radius());
      case Form::kGeneral:
        break;
    }
    return kernels::bayes_general_work(state_, radius(), kernels::bayes_scales_sums(mu_, floor_),
                                       edges_ != nullptr);
  }

  Form form_;
  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  const EdgeWeights* edges_;
  Image<float> neutral_;  ///< stands for the neighbours outside the image
  const CandidateBlocks* blocks_;
  std::optional<BlockStars<float>> stars_;  ///< where there are blocks
};

/// The state before the first iteration of a level, from the probabilities that the next coarser
/// one ended with.
class BayesFromCoarserStage final : public FromCoarserStage<float> {
 public:
  BayesFromCoarserStage(const MethodParameters& parameters,
                        const kernels::CandidateGeometry& geometry, int height, BayesState state,
                        const CoarserResult& coarser, const CandidateBlocks* blocks)
      : FromCoarserStage(geometry, height, coarser, blocks),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)) {}

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::bayes_start_from_coarser_work(state_, radius()),
                                candidates());
  }

 protected:
  /// Probabilities, and what smoothing needs.
  [[nodiscard]] std::size_t work_cells() const override {
    return kCoarserColumns * static_cast<std::size_t>(lanes()) +
           work_floats(lanes(), radius(), blocks());
  }

  void make_states(const kernels::CompactRow& coarser, std::span<const int> segment_ends,
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
    row.segment_ends = segment_ends;
    row.work = work + kCoarserColumns * static_cast<std::size_t>(lanes());
    kernels::bayes_start_row(row);
  }

 private:
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }

  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const CoarserResult& coarser, const EdgeWeights* edges, const CandidateBlocks* blocks) {
  const bool half = parameters.mu == 0.5 && edges == nullptr &&
                    parameters.epsilon_prior >= kLeastEpsilonOfProductForm;
  const BayesState between = half ? BayesState::kSmoothed : BayesState::kLogSmoothed;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  for (int i = 0; i <= parameters.iterations; ++i) {
    const Form form = i == 0 ? Form::kStart : half ? Form::kHalf : Form::kGeneral;
    const BayesState state = i == parameters.iterations ? BayesState::kProbability : between;
    if (i == 0 && coarser.volume != nullptr) {
      stages.push_back(std::make_unique<BayesFromCoarserStage>(parameters, geometry, height, state,
                                                               coarser, blocks));
      continue;
    }
    stages.push_back(
        std::make_unique<BayesStage>(parameters, geometry, height, form, state, edges, blocks));
  }
  return stages;
}

}  // namespace vantage
