#include "engine/matching/stage_bayes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>

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

/// As many candidates as columns of cells have room for.
kernels::CandidateGeometry cell_geometry(const kernels::CandidateGeometry& geometry,
                                         const CandidateBlocks* blocks) {
  kernels::CandidateGeometry cells = geometry;
  if (blocks != nullptr) {
    cells.count = blocks->lanes();
  }
  return cells;
}

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
           (work_floats(lanes(), radius(), blocks_) + (stars_ ? stars_->work_floats() : 0));
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
  std::optional<BlockStars> stars_;  ///< where there are blocks
};

/// The state before the first iteration of a level, from the probabilities that the next coarser
/// one ended with: column x of row y lies in column x/2 of row y/2 there. Takes part in the chain
/// like the start from likelihoods, so that iterations find their source, but looks at no input.
class BayesFromCoarserStage final : public scheduler::RowStage {
 public:
  BayesFromCoarserStage(const MethodParameters& parameters,
                        const kernels::CandidateGeometry& geometry, int height, BayesState state,
                        const CoarserProbabilities& coarser, const CandidateBlocks* blocks)
      : RowStage({geometry.width, height}),
        lanes_(cell_geometry(geometry, blocks).lanes()),
        count_(geometry.count),
        state_(state),
        mu_(static_cast<float>(parameters.mu)),
        taps_(prior_taps(parameters, geometry.count)),
        floor_(static_cast<float>(parameters.epsilon_prior)),
        coarser_(coarser),
        blocks_(blocks),
        all_blocks_(static_cast<std::size_t>(geometry.lanes() / kernels::kLaneMultiple)) {
    std::iota(all_blocks_.begin(), all_blocks_.end(), std::uint16_t{0});
  }

  [[nodiscard]] std::string_view name() const override { return "Bayes start from coarser"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * lanes(); }
  /// Of a few coarser columns: probabilities as floats and as bytes, states, and what smoothing
  /// needs.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) *
               (2 * kCoarserColumns * lanes() + work_floats(lanes_, radius(), blocks_)) +
           kCoarserColumns * lanes();
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::bayes_start_from_coarser_work(state_, radius()),
                                candidates_in(blocks_, count_));
  }

  void make_row(const scheduler::RowTask& task) const override {
    if (task.y % 2 == 1 && task.previous != nullptr) {
      // Both rows are the same one of the coarser level.
      if (task.previous != task.output) {
        std::memcpy(task.output, task.previous,
                    bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
      }
      return;
    }
    if (blocks_ == nullptr) {
      make_columns(task, {task.columns, all_blocks_}, count_);
      return;
    }
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      make_columns(task, run, blocks_->count(run.blocks));
      x = run.columns.end;
    }
  }

 private:
  static constexpr int kCoarserColumns = 8;

  [[nodiscard]] std::size_t lanes() const { return static_cast<std::size_t>(lanes_); }
  [[nodiscard]] int radius() const { return static_cast<int>(taps_.size()) - 1; }

  /// count: candidates in the lanes of the run.
  void make_columns(const scheduler::RowTask& task, const CandidateBlocks::Run& run,
                    int count) const {
    const std::size_t run_lanes = run.blocks.size() * kernels::kLaneMultiple;
    auto* const output = reinterpret_cast<float*>(task.output);
    const float* const states = reinterpret_cast<const float*>(task.state);
    const int end = (run.columns.end + 1) / 2;
    for (int first = run.columns.begin / 2; first < end; first += kCoarserColumns) {
      const int columns = std::min(kCoarserColumns, end - first);
      make_states(task, run.blocks, count, first, columns);
      for (int x = std::max(2 * first, run.columns.begin);
           x < std::min(2 * (first + columns), run.columns.end); ++x) {
        std::copy_n(states + run_lanes * static_cast<std::size_t>(x / 2 - first), run_lanes,
                    output + lanes() * static_cast<std::size_t>(x - task.columns.begin));
      }
    }
  }

  /// Of columns of the coarser level, at the beginning of the state.
  void make_states(const scheduler::RowTask& task, BlockList blocks, int count, int first,
                   int columns) const {
    const int run_lanes = static_cast<int>(blocks.size()) * kernels::kLaneMultiple;
    auto* const states = reinterpret_cast<float*>(task.state);
    float* const probabilities = states + kCoarserColumns * lanes();
    float* const work = probabilities + kCoarserColumns * lanes();
    auto* const bytes =
        reinterpret_cast<std::uint8_t*>(work + work_floats(lanes_, radius(), blocks_));
    for (int j = 0; j < columns; ++j) {
      const int x = first + j;
      const BlockList own =
          coarser_.blocks == nullptr ? all_blocks_ : coarser_.blocks->at(x, task.y / 2);
      copy_blocks<std::uint8_t>(coarser_.volume->column<std::uint8_t>(x, task.y / 2), own, blocks,
                                kernels::kMostCompact,
                                bytes + static_cast<std::ptrdiff_t>(j) * run_lanes);
    }
    kernels::probabilities_of_compact_row(
        {.cells = bytes, .columns = columns, .lanes = run_lanes, .count = count}, probabilities);
    const BlockSegments segments(blocks);
    kernels::BayesRow row;
    row.star.centre = row.star.up = row.star.down = row.star.source = probabilities;
    row.star.left_of_first = row.star.right_of_last = probabilities;
    row.star.columns = columns;
    row.star.lanes = run_lanes;
    row.prior = {taps_.data(), radius(), floor_};
    row.state = state_;
    row.mu = mu_;
    row.count = count;
    row.output = states;
    row.source_pitch = row.output_pitch = run_lanes;
    row.segment_ends = segments.ends();
    row.work = work;
    kernels::bayes_start_row(row);
  }

  int lanes_;
  int count_;
  BayesState state_;
  float mu_;
  std::vector<float> taps_;
  float floor_;
  CoarserProbabilities coarser_;
  const CandidateBlocks* blocks_;
  std::vector<std::uint16_t> all_blocks_;
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const CoarserProbabilities& coarser, const EdgeWeights* edges, const CandidateBlocks* blocks) {
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
