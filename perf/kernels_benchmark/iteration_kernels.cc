// One row of each iteration on a disparity space, again and again.

#include <utility>

#include "kernels/bayes_step/bayes_step.h"
#include "kernels/diffusion_step/diffusion_step.h"
#include "kernels/local_stopping_step/local_stopping_step.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "tests/kernels/star_rows.h"

namespace vantage::perf {
namespace {

using kernels::BayesRow;
using kernels::BayesState;
using kernels::CertaintyMeasure;
using kernels::StarRows;

// Three rows with a column beyond either end, the source and the output: 22 KiB.
constexpr int kColumns = 16;
constexpr int kLanes = 64;
constexpr double kCells = kColumns * kLanes;
constexpr int kCarryingPitch = kLanes + kernels::kCertaintyFloats;

class Rows {
 public:
  void bayes_start() { kernels::bayes_start_row(bayes(probabilities_, 0, BayesState::kSmoothed)); }
  void bayes_half(int radius) {
    kernels::bayes_half_row(bayes(probabilities_, radius, BayesState::kSmoothed));
  }
  void bayes_general() {
    kernels::bayes_general_row(bayes(logarithms_, 0, BayesState::kLogSmoothed));
  }
  void diffusion(float pull) {
    kernels::DiffusionRow row;
    row.star = probabilities_.star();
    row.pull = pull;
    row.output = output_.row(0);
    kernels::diffusion_row(row);
  }
  void stopping(CertaintyMeasure measure) {
    kernels::LocalStoppingRow row;
    row.star = carrying_.star();
    row.measure = measure;
    row.count = kLanes;
    row.output = output_.row(0);
    row.output_pitch = kCarryingPitch;
    kernels::local_stopping_row(row);
  }

 private:
  BayesRow bayes(const StarRows& rows, int radius, BayesState state) {
    BayesRow row;
    row.star = rows.star();
    row.prior = {taps_, radius, 0.01F};
    row.state = state;
    row.mu = 0.4F;
    row.count = kLanes;
    row.output = output_.row(0);
    row.work = work_.row(0);
    return row;
  }

  StarRows probabilities_{kColumns, kLanes, kLanes, 0.01F, 1, 1};
  StarRows logarithms_{kColumns, kLanes, kLanes, -2, 0, 2};
  StarRows carrying_{kColumns, kLanes, kCarryingPitch, 0, 1, 3};
  float taps_[2] = {0.99F, 0.04F};
  Image<float> output_{kColumns * kCarryingPitch, 1};
  Image<float> work_{kernels::bayes_work_floats(kLanes, 1), 1};
};

KernelBenchmark row(std::string name, KernelWork work, void (*call)(Rows&)) {
  return on_own_data<Rows>(std::move(name), "cell", kCells, work, call);
}

}  // namespace

KernelBenchmarks iteration_kernels() {
  // Product of the star 4, estimate of 1/√ 1, Newton's step 4, p0 1; the sum over lanes 1.
  constexpr double kHalf = 11;
  return {
      // Sum, tap, floor; cells wait in working memory for the sum over their column.
      row("bayes_start_row", {4, 16}, [](Rows& d) { d.bayes_start(); }),
      row("bayes_half_row", {kHalf + 2, 28}, [](Rows& d) { d.bayes_half(0); }),
      row("bayes_half_row/three taps", {kHalf + 6, 44}, [](Rows& d) { d.bayes_half(1); }),
      // Sum of the star 4, exponential 17, p0 1, sum over lanes 1; tap, floor, logarithm, μ.
      row("bayes_general_row", {23 + 28, 36}, [](Rows& d) { d.bayes_general(); }),
      row("diffusion_row", {6, 24}, [](Rows& d) { d.diffusion(0); }),
      row("diffusion_row/membrane", {8, 28}, [](Rows& d) { d.diffusion(0.075F); }),
      row("local_stopping_row/margin", {10, 24},
          [](Rows& d) { d.stopping(CertaintyMeasure::kMargin); }),
      row("local_stopping_row/entropy", {6 + 1 + 3 + 17 + 3, 32},
          [](Rows& d) { d.stopping(CertaintyMeasure::kEntropy); }),
  };
}

}  // namespace vantage::perf
