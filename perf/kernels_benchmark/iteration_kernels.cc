// Repeats one row of each iteration on a disparity space.

#include <string>
#include <utility>

#include "kernels/bayes_step/bayes_step.h"
#include "kernels/diffusion_step/diffusion_step.h"
#include "kernels/local_stopping_step/local_stopping_step.h"
#include "kernels/max_product_step/max_product_step.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "tests/kernels/star_rows.h"

namespace vantage::perf {
namespace {

using kernels::BayesRow;
using kernels::BayesState;
using kernels::CellStarRows;
using kernels::CertaintyMeasure;
using kernels::FixedEnergy;
using kernels::MaxProductRow;
using kernels::StarRows;

// Three rows with one column beyond each end, the source and the output: 22 KiB.
constexpr int kColumns = 16;
constexpr int kLanes = 64;
constexpr double kCells = kColumns * kLanes;
constexpr int kCarryingPitch = kLanes + kernels::kCertaintyFloats;
constexpr float kMu = 0.4F;
constexpr float kFloor = 0.01F;  // floor of the prior

class Rows {
 public:
  void bayes_start() { kernels::bayes_start_row(bayes(probabilities_, 0, BayesState::kSmoothed)); }
  void bayes_half(int radius) {
    kernels::bayes_half_row(bayes(probabilities_, radius, BayesState::kSmoothed));
  }
  void bayes_general(int radius) {
    kernels::bayes_general_row(bayes(logarithms_, radius, BayesState::kLogSmoothed));
  }
  void bayes_weighted() {
    BayesRow row = bayes(logarithms_, 1, BayesState::kLogSmoothed);
    row.weights = {weights_.row(0), weights_.row(1), weights_.row(2)};
    kernels::bayes_general_row(row);
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
  static Image<float> made_weights() {
    Image<float> weights(kColumns + 1, 3);
    weights.fill(0.7F);
    return weights;
  }
  BayesRow bayes(const StarRows& rows, int radius, BayesState state) {
    BayesRow row;
    row.star = rows.star();
    row.prior = {taps_, radius, kFloor};
    row.state = state;
    row.mu = kMu;
    row.count = kLanes;
    row.output = output_.row(0);
    row.source_pitch = row.output_pitch = kLanes;
    row.work = work_.row(0);
    return row;
  }

  StarRows probabilities_{kColumns, kLanes, kLanes, 0.01F, 1, 1};
  StarRows logarithms_{kColumns, kLanes, kLanes, -2, 0, 2};
  StarRows carrying_{kColumns, kLanes, kCarryingPitch, 0, 1, 3};
  Image<float> weights_ = made_weights();
  float taps_[2] = {0.99F, 0.04F};
  Image<float> output_{kColumns * kCarryingPitch, 1};
  Image<float> work_{kernels::bayes_work_floats(kLanes, 1), 1};
};

// Same for fixed-point energies.
template <int kEnergyLanes>
class EnergyRows {
 public:
  void start() { kernels::max_product_start_row(row()); }
  void step() { kernels::max_product_row(row()); }
  void weighted_step() {
    MaxProductRow weighted = row();
    weighted.weights = {weights_.row(0), weights_.row(1), weights_.row(2)};
    kernels::max_product_row(weighted);
  }

 private:
  static Image<kernels::FixedWeight> made_weights() {
    Image<kernels::FixedWeight> weights(kColumns + 1, 3);
    weights.fill(kernels::fixed_weight(0.7F * kMu));
    return weights;
  }
  MaxProductRow row() {
    MaxProductRow row;
    row.star = energies_.star();
    row.prior = {&rise_, 1, 1000};
    row.mu = kernels::fixed_weight(kMu);
    row.output = output_.row(0);
    row.source_pitch = row.output_pitch = kEnergyLanes;
    row.work = work_.row(0);
    return row;
  }

  CellStarRows<FixedEnergy> energies_{kColumns, kEnergyLanes, kEnergyLanes, 0, 1000, 1};
  Image<kernels::FixedWeight> weights_ = made_weights();
  FixedEnergy rise_ = 50;
  Image<FixedEnergy> output_{kColumns * kEnergyLanes, 1};
  Image<FixedEnergy> work_{kernels::max_product_work_cells(kEnergyLanes, 1), 1};
};

KernelBenchmark row(std::string name, const kernels::KernelWork& work, void (*call)(Rows&)) {
  return on_own_data<Rows>(std::move(name), "cell", kCells, per_cell(work, kLanes), call);
}

template <int kEnergyLanes>
KernelBenchmark energy_row(std::string name, const kernels::KernelWork& work,
                           void (*call)(EnergyRows<kEnergyLanes>&)) {
  name += "/" + std::to_string(kEnergyLanes) + " candidates";
  return on_own_data<EnergyRows<kEnergyLanes>>(
      std::move(name), "cell", double{kColumns} * kEnergyLanes, per_cell(work, kEnergyLanes), call);
}

}  // namespace

KernelBenchmarks iteration_kernels() {
  using kernels::bayes_half_work;
  const auto general_work = [](int radius, bool weighted) {
    return kernels::bayes_general_work(BayesState::kLogSmoothed, radius,
                                       kernels::bayes_scales_sums(kMu, kFloor), weighted);
  };
  return {
      row("bayes_start_row", kernels::bayes_start_work(BayesState::kSmoothed, 0),
          [](Rows& d) { d.bayes_start(); }),
      row("bayes_half_row", bayes_half_work(BayesState::kSmoothed, 0),
          [](Rows& d) { d.bayes_half(0); }),
      row("bayes_half_row/three taps", bayes_half_work(BayesState::kSmoothed, 1),
          [](Rows& d) { d.bayes_half(1); }),
      row("bayes_general_row", general_work(0, false), [](Rows& d) { d.bayes_general(0); }),
      row("bayes_general_row/three taps", general_work(1, false),
          [](Rows& d) { d.bayes_general(1); }),
      row("bayes_general_row/three taps, weighted", general_work(1, true),
          [](Rows& d) { d.bayes_weighted(); }),
      energy_row<48>("max_product_start_row", kernels::max_product_start_work(1),
                     [](EnergyRows<48>& d) { d.start(); }),
      energy_row<48>("max_product_row", kernels::max_product_work(1, true, false),
                     [](EnergyRows<48>& d) { d.step(); }),
      energy_row<48>("max_product_row/weighted", kernels::max_product_work(1, true, true),
                     [](EnergyRows<48>& d) { d.weighted_step(); }),
      energy_row<128>("max_product_row/weighted", kernels::max_product_work(1, true, true),
                      [](EnergyRows<128>& d) { d.weighted_step(); }),
      row("diffusion_row", kernels::diffusion_work(false), [](Rows& d) { d.diffusion(0); }),
      row("diffusion_row/membrane", kernels::membrane_work(false),
          [](Rows& d) { d.diffusion(0.075F); }),
      row("local_stopping_row/margin",
          kernels::local_stopping_work(CertaintyMeasure::kMargin, true, true, false),
          [](Rows& d) { d.stopping(CertaintyMeasure::kMargin); }),
      row("local_stopping_row/entropy",
          kernels::local_stopping_work(CertaintyMeasure::kEntropy, true, true, false),
          [](Rows& d) { d.stopping(CertaintyMeasure::kEntropy); }),
  };
}

}  // namespace vantage::perf
