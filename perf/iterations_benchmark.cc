// Google Benchmark of the iterations on a disparity space, once per instruction set this machine
// has: one row of 64 columns and 64 disparities, again and again, so that data stays in the fast
// caches. Figures per cell: "items" are cells.

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "kernels/bayes_step/bayes_step.h"
#include "kernels/diffusion_step/diffusion_step.h"
#include "kernels/local_stopping_step/local_stopping_step.h"
#include "kernels/simd_target.h"
#include "tests/kernels/star_rows.h"

namespace vantage::kernels {
namespace {

constexpr int kColumns = 64;
constexpr int kLanes = 64;
constexpr int kCarryingPitch = kLanes + kCertaintyFloats;

class Rows {
 public:
  void bayes_start() { bayes_start_row(bayes(probabilities_, 0, BayesState::kSmoothed)); }
  void bayes_half() { bayes_half_row(bayes(probabilities_, 0, BayesState::kSmoothed)); }
  void bayes_half_three_taps() { bayes_half_row(bayes(probabilities_, 1, BayesState::kSmoothed)); }
  void bayes_general() { bayes_general_row(bayes(logarithms_, 0, BayesState::kLogSmoothed)); }
  void diffusion() { diffusion_row(linear(0)); }
  void membrane() { diffusion_row(linear(0.075F)); }
  void stopping_by_margin() { local_stopping_row(stopping(CertaintyMeasure::kMargin)); }
  void stopping_by_entropy() { local_stopping_row(stopping(CertaintyMeasure::kEntropy)); }

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
  DiffusionRow linear(float pull) {
    DiffusionRow row;
    row.star = probabilities_.star();
    row.pull = pull;
    row.output = output_.row(0);
    return row;
  }
  LocalStoppingRow stopping(CertaintyMeasure measure) {
    LocalStoppingRow row;
    row.star = carrying_.star();
    row.measure = measure;
    row.count = kLanes;
    row.output = output_.row(0);
    row.output_pitch = kCarryingPitch;
    return row;
  }

  StarRows probabilities_{kColumns, kLanes, kLanes, 0.01F, 1, 1};
  StarRows logarithms_{kColumns, kLanes, kLanes, -2, 0, 2};
  StarRows carrying_{kColumns, kLanes, kCarryingPitch, 0, 1, 3};
  float taps_[2] = {0.99F, 0.04F};
  Image<float> output_{kColumns * kCarryingPitch, 1};
  Image<float> work_{bayes_work_floats(kLanes, 1), 1};
};

struct Kernel {
  std::string name;
  void (Rows::*run)();
};

void run(benchmark::State& state, long long target, const Kernel& kernel) {
  force_target(target);
  Rows rows;
  for (auto _ : state) {
    (rows.*kernel.run)();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kColumns * kLanes);
  force_target(0);
}

void register_all() {
  const std::vector<Kernel> all = {
      {"bayes start", &Rows::bayes_start},
      {"bayes, mu 1/2", &Rows::bayes_half},
      {"bayes, mu 1/2, three taps", &Rows::bayes_half_three_taps},
      {"bayes, any mu", &Rows::bayes_general},
      {"diffusion", &Rows::diffusion},
      {"membrane", &Rows::membrane},
      {"local stopping, margin", &Rows::stopping_by_margin},
      {"local stopping, entropy", &Rows::stopping_by_entropy},
  };
  const long long available = available_targets();
  for (const Kernel& kernel : all) {
    for (int bit = 0; bit < 63; ++bit) {
      if (const long long target = 1LL << bit; (available & target) != 0) {
        benchmark::RegisterBenchmark(
            (kernel.name + "/" + std::string(target_name(target))).c_str(),
            [target, kernel](benchmark::State& state) { run(state, target, kernel); });
      }
    }
  }
}

}  // namespace
}  // namespace vantage::kernels

int main(int argc, char** argv) {
  vantage::kernels::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
