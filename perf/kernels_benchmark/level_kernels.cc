// Repeats one row of each operation between two pyramid levels.

#include <algorithm>
#include <cstdint>
#include <utility>

#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/fixed_energies/fixed_energies.h"
#include "kernels/half_energies/half_energies.h"
#include "kernels/pair_reduction/pair_reduction.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {
namespace {

// Two rows of the finer level and one of the coarser: 10 KiB.
constexpr int kColumns = 16;
constexpr int kLanes = 64;
constexpr std::size_t kFineCells = kColumns * kLanes;
constexpr std::size_t kCoarseCells = kFineCells / 2;

class Rows {
 public:
  void reduce_likelihoods() {
    kernels::reduce_likelihoods_row({upper_.data(), lower_.data(), kColumns, kLanes}, 1,
                                    work_.data(), bytes_.data());
  }
  void reduce_compact_energies() {
    kernels::reduce_compact_energies_row({compact_.data(), lower_compact_.data(), kColumns, kLanes},
                                         0.6F, sums_.data(), bytes_.data());
  }
  void allow_slant() { kernels::allow_slant_row(slanted_.data(), kColumns, kLanes, 4); }
  void reduce_pair_energies() {
    const kernels::PairRow row{
        .columns = kColumns, .lanes = kLanes, .count = kColumns, .work = pair_sums_.data()};
    kernels::start_pair_row(row);
    kernels::reduce_left_part(row, {compact_.data(), lower_compact_.data(), kColumns, kLanes}, 0,
                              bytes_.data());
    kernels::reduce_right_row(row, right_bytes_.data());
  }
  void likelihoods_of_compact() {
    kernels::likelihoods_of_compact_row({compact_.data(), kColumns, kLanes, kLanes},
                                        output_.data());
  }
  void compact_probabilities() {
    kernels::compact_probabilities_row(upper_.data(), kFineCells, bytes_.data());
  }
  void fixed_energies_of_bytes() {
    kernels::fixed_energies_of_bytes_row({compact_.data(), kColumns, kLanes, kLanes},
                                         kernels::ByteSteps(32), fixed_.data());
  }
  void fixed_energies_of_likelihoods() {
    kernels::fixed_energies_of_likelihoods_row({upper_.data(), kColumns, kLanes, kLanes}, 256,
                                               fixed_.data());
  }
  void bytes_of_fixed_energies() {
    kernels::bytes_of_fixed_energies_row(stored_fixed_.data(), kFineCells,
                                         kernels::fixed_weight(1.0F / 32), bytes_.data());
  }
  void reduce_energies() {
    kernels::reduce_energies_row({upper_.data(), lower_.data(), kColumns, kLanes}, 1,
                                 halves_.data());
  }
  void half_energies() { kernels::half_energies_row(upper_.data(), kFineCells, 1, halves_.data()); }
  void energies_from_coarser() {
    kernels::energies_from_coarser_row({stored_.data(), 0, kColumns, kLanes, 1}, output_.data());
  }
  void energies_with_coarser() {
    kernels::energies_with_coarser_row({stored_.data(), 0, kColumns, kLanes, 1}, upper_.data(),
                                       output_.data());
  }

 private:
  AlignedValues<float> upper_{kFineCells, 1000, 0.001F, 1};
  AlignedValues<float> lower_{kFineCells, 1000, 0.001F, 2};
  AlignedValues<std::uint8_t> compact_{kFineCells, 256, 1, 3};
  AlignedValues<std::uint8_t> lower_compact_{kFineCells, 256, 1, 6};
  AlignedValues<std::uint8_t> slanted_{kFineCells, 256, 1, 7};
  AlignedValues<std::uint16_t> sums_{kLanes};
  AlignedValues<std::uint16_t> pair_sums_{kernels::pair_row_work(kColumns, kLanes, 0)};
  AlignedValues<std::uint16_t> stored_{kCoarseCells, 15360, 1, 4};
  AlignedValues<kernels::FixedEnergy> stored_fixed_{kFineCells, 10000, 1, 5};
  AlignedValues<float> work_{kLanes};
  AlignedValues<float> output_{kFineCells};
  AlignedValues<std::uint8_t> bytes_{kFineCells};
  AlignedValues<std::uint8_t> right_bytes_{kCoarseCells};
  AlignedValues<std::uint16_t> halves_{kFineCells};
  AlignedValues<kernels::FixedEnergy> fixed_{kFineCells};
};

KernelBenchmark row(std::string name, double cells, const kernels::KernelWork& work,
                    void (*call)(Rows&)) {
  return on_own_data<Rows>(std::move(name), "cell", cells, per_cell(work, kLanes), call);
}

}  // namespace

KernelBenchmarks level_kernels() {
  return {
      // Cells of the coarser row.
      row("reduce_likelihoods_row", kCoarseCells, kernels::kReduceLikelihoodsWork,
          [](Rows& d) { d.reduce_likelihoods(); }),
      row("reduce_compact_energies_row", kCoarseCells, kernels::kReduceCompactEnergiesWork,
          [](Rows& d) { d.reduce_compact_energies(); }),
      row("allow_slant_row", kFineCells, kernels::kAllowSlantWork,
          [](Rows& d) { d.allow_slant(); }),
      row("reduce_pair_row", kCoarseCells, kernels::kReducePairEnergiesWork,
          [](Rows& d) { d.reduce_pair_energies(); }),
      row("reduce_energies_row", kCoarseCells, kernels::kReduceEnergiesWork,
          [](Rows& d) { d.reduce_energies(); }),
      row("likelihoods_of_compact_row", kFineCells, kernels::kExpandCompactWork,
          [](Rows& d) { d.likelihoods_of_compact(); }),
      row("compact_probabilities_row", kFineCells, kernels::kCompactProbabilitiesWork,
          [](Rows& d) { d.compact_probabilities(); }),
      row("fixed_energies_of_bytes_row", kFineCells, kernels::kFixedEnergiesOfBytesWork,
          [](Rows& d) { d.fixed_energies_of_bytes(); }),
      row("fixed_energies_of_likelihoods_row", kFineCells, kernels::kFixedEnergiesOfLikelihoodsWork,
          [](Rows& d) { d.fixed_energies_of_likelihoods(); }),
      row("bytes_of_fixed_energies_row", kFineCells, kernels::kBytesOfFixedEnergiesWork,
          [](Rows& d) { d.bytes_of_fixed_energies(); }),
      row("half_energies_row", kFineCells, kernels::kHalfEnergiesWork,
          [](Rows& d) { d.half_energies(); }),
      row("energies_from_coarser_row", kFineCells, kernels::kExpandHalfWork,
          [](Rows& d) { d.energies_from_coarser(); }),
      row("energies_with_coarser_row", kFineCells, kernels::kCoarserSupportWork,
          [](Rows& d) { d.energies_with_coarser(); }),
  };
}

}  // namespace vantage::perf
