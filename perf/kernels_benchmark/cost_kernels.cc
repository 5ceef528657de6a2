// Matching costs per cell, and the planes they read.

#include <algorithm>
#include <utility>
#include <vector>

#include "kernels/census/census.h"
#include "kernels/evidence/evidence.h"
#include "kernels/gradient/gradient.h"
#include "kernels/partner_choice/partner_choice.h"
#include "kernels/pixel_cost/pixel_cost.h"
#include "kernels/ray_census/ray_census.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {
namespace {

constexpr int kColumns = 64;
constexpr int kLanes = 64;
constexpr double kCells = kColumns * kLanes;
constexpr std::size_t kCellCount = kColumns * kLanes;
constexpr int kPixels = 512;

/// Rows of feature planes and the cells computed from them.
template <typename T, int kPlanes>
struct Pairs {
  AlignedValues<T> reference{kPlanes * kPixels, 256, T{1}, 1};
  AlignedValues<T> partner{kPlanes * kPixels, 256, T{1}, 2};
  AlignedValues<float> cells{kCellCount};
  kernels::FeaturePairs<T, kPlanes> row;

  Pairs() {
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      row.channel[0].reference[plane] = reference.data() + plane * kPixels;
      row.channel[0].partner[plane] = partner.data() + plane * kPixels;
    }
    row.columns = kColumns;
    row.lanes = kLanes;
    row.count = kLanes;
  }
};
using Grey = Pairs<float, 1>;
using Sampled = Pairs<float, 3>;
using Gradients = Pairs<float, 3>;
using Codes = Pairs<std::uint32_t, 2>;

/// Distances, and table lookups by distance.
template <int kThresholds>
struct RayCodes : Pairs<std::uint8_t, kernels::kMaxRayCensusBytes> {
  kernels::RayCensusPairs pairs{row, kThresholds};
  AlignedValues<std::uint8_t> bytes{kCellCount};
  kernels::LikelihoodByDistance likelihoods;
  kernels::ByteByDistance energies;
};

struct Cells {
  AlignedValues<float> cells{kCellCount, 1000, 1e-3F, 1};
  AlignedValues<float> chosen{kCellCount};
  std::vector<kernels::CandidateRange> seen;  // of two partners
  kernels::CellExtent row{kColumns, kLanes, kLanes};

  Cells() : seen(2 * kColumns, {0, kLanes}) {}
};

/// Rows of an image with margins, and the outputs computed from them.
struct ImageRows {
  static constexpr int kWidth = 256;
  static constexpr std::size_t kStride = 512;
  static constexpr int kMargin = 16;
  AlignedValues<float> pixels{9 * kStride, 256, 1.0F};
  AlignedValues<float> work{kStride};
  AlignedValues<float> first{kStride, 256, 1.0F};
  AlignedValues<float> second{kStride, 256, 1.0F};
  AlignedValues<float> third{kStride};
  AlignedValues<std::uint32_t> first_code{kStride};
  AlignedValues<std::uint32_t> second_code{kStride};
  AlignedValues<std::uint8_t> code_bytes{kernels::kMaxRayCensusBytes * kStride};

  const float* row(std::size_t y) { return pixels.data() + y * kStride + kMargin; }

  void filter() {
    kernels::SeparableFilter filter;
    for (std::size_t y = 0; y < 5; ++y) {
      filter.rows[y] = row(y);
    }
    filter.down = {0.05F, 0.2F, 0.5F, 0.2F, 0.05F};
    filter.along = {-0.1F, -0.3F, 0.0F, 0.3F, 0.1F};
    filter.width = kWidth;
    kernels::separable_filter_row(filter, work.data(), third.data());
  }
  void evidence_planes() {
    // α = 1 keeps the gradients constant from call to call.
    kernels::evidence_planes_row({first.data(), second.data(), third.data(), kWidth}, 1.0F,
                                 kernels::EvidenceNorm::kL2);
  }
  void census() {
    kernels::CensusRows rows;
    for (std::size_t y = 0; y < rows.size(); ++y) {
      rows[y] = row(y);
    }
    kernels::census_code_row(rows, kWidth, first_code.data(), second_code.data());
  }
  void ray_census(int thresholds) {
    kernels::RayCensusRows rows;
    for (std::size_t y = 0; y < rows.size(); ++y) {
      rows[y] = row(y);
    }
    kernels::RayCensusCodes codes{};
    for (std::size_t p = 0; p < codes.size(); ++p) {
      codes[p] = code_bytes.data() + p * kStride;
    }
    kernels::ray_census_code_row(rows, kWidth, thresholds, codes);
  }
  void bounds() { kernels::sampling_bounds_row(row(0), kWidth, first.data(), second.data()); }
};

void likelihood_of_evidence(Cells& data) {
  const kernels::EvidenceRow row{{2000, 0, kLanes, -1}, 500, kColumns};
  kernels::likelihood_of_evidence(row, 10.0F, 0.01F, data.cells.data());
}

}  // namespace

KernelBenchmarks cost_kernels() {
  const auto model = kernels::ContaminatedGaussian::of(5, 0.01);
  const auto cells = [](std::string name, const kernels::KernelWork& work, auto call) {
    return on_own_data<Cells>(std::move(name), "cell", kCells, per_cell(work, kLanes), call);
  };
  const auto grey = [](std::string name, const kernels::KernelWork& work, auto call) {
    return on_own_data<Grey>(std::move(name), "cell", kCells, per_cell(work, kLanes), call);
  };
  const auto pixels = [](std::string name, UnitWork work, auto call) {
    return on_own_data<ImageRows>(std::move(name), "pixel", ImageRows::kWidth, work, call);
  };
  return {
      grey("squared_row", kernels::squared_work(1),
           [](Grey& d) { kernels::squared_row(d.row, d.cells.data()); }),
      grey("absolute_row", kernels::absolute_work(1),
           [](Grey& d) { kernels::absolute_row(d.row, 20, d.cells.data()); }),
      grey("contaminated_energy_row", kernels::contaminated_energy_work(1),
           [model](Grey& d) { kernels::contaminated_energy_row(d.row, model, d.cells.data()); }),
      grey(
          "contaminated_likelihood_row", kernels::contaminated_likelihood_work(1),
          [model](Grey& d) { kernels::contaminated_likelihood_row(d.row, model, d.cells.data()); }),
      on_own_data<Sampled>(
          "sampling_insensitive_row", "cell", kCells,
          per_cell(kernels::sampling_insensitive_work(1), kLanes),
          [](Sampled& d) { kernels::sampling_insensitive_row(d.row, d.cells.data()); }),
      on_own_data<Gradients>(
          "negated_evidence_row/L2", "cell", kCells,
          per_cell(kernels::negated_evidence_work(kernels::EvidenceNorm::kL2, 1), kLanes),
          [](Gradients& d) {
            kernels::negated_evidence_row(d.row, kernels::EvidenceNorm::kL2, d.cells.data());
          }),
      on_own_data<Gradients>(
          "negated_evidence_row/octagon", "cell", kCells,
          per_cell(kernels::negated_evidence_work(kernels::EvidenceNorm::kOctagon, 1), kLanes),
          [](Gradients& d) {
            kernels::negated_evidence_row(d.row, kernels::EvidenceNorm::kOctagon, d.cells.data());
          }),
      on_own_data<Gradients>(
          "negated_evidence_row/x", "cell", kCells,
          per_cell(kernels::negated_evidence_work(kernels::EvidenceNorm::kAcross, 1), kLanes),
          [](Gradients& d) {
            kernels::negated_evidence_row(d.row, kernels::EvidenceNorm::kAcross, d.cells.data());
          }),
      on_own_data<Codes>("hamming_row", "cell", kCells, per_cell(kernels::hamming_work(1), kLanes),
                         [](Codes& d) { kernels::hamming_row(d.row, d.cells.data()); }),
      on_own_data<RayCodes<1> >(
          "ray_hamming_row", "cell", kCells, per_cell(kernels::ray_hamming_work(1, 1), kLanes),
          [](RayCodes<1>& d) { kernels::ray_hamming_row(d.pairs, d.cells.data()); }),
      on_own_data<RayCodes<1> >("ray_census_likelihood_row", "cell", kCells,
                                per_cell(kernels::ray_census_likelihood_work(1), kLanes),
                                [](RayCodes<1>& d) {
                                  kernels::ray_census_likelihood_row(d.pairs, d.likelihoods,
                                                                     d.cells.data());
                                }),
      on_own_data<RayCodes<1> >("ray_census_energy_row", "cell", kCells,
                                per_cell(kernels::ray_census_energy_work(1), kLanes),
                                [](RayCodes<1>& d) {
                                  kernels::ray_census_energy_row(d.pairs, d.energies,
                                                                 d.bytes.data());
                                }),
      on_own_data<RayCodes<3> >("ray_census_energy_row/3", "cell", kCells,
                                per_cell(kernels::ray_census_energy_work(3), kLanes),
                                [](RayCodes<3>& d) {
                                  kernels::ray_census_energy_row(d.pairs, d.energies,
                                                                 d.bytes.data());
                                }),
      cells("likelihood_of_costs", kernels::kLikelihoodOfCostsWork,
            [model](Cells& d) { kernels::likelihood_of_costs(d.row, model, d.cells.data()); }),
      cells("likelihood_of_energies", kernels::kLikelihoodOfEnergiesWork,
            [](Cells& d) { kernels::likelihood_of_energies(d.row, d.cells.data()); }),
      cells("likelihood_of_evidence", kernels::kLikelihoodOfEvidenceWork, likelihood_of_evidence),
      cells("choose_likelihoods_row", kernels::choose_partners_work(2, true),
            [](Cells& d) {
              kernels::choose_likelihoods_row({.cells = d.cells.data(),
                                               .seen = d.seen.data(),
                                               .partners = 2,
                                               .columns = kColumns,
                                               .lanes = kLanes,
                                               .count = kLanes},
                                              d.chosen.data());
            }),
      pixels("separable_filter_row", {18, 48}, [](ImageRows& d) { d.filter(); }),
      pixels("evidence_planes_row/L2", {7, 20}, [](ImageRows& d) { d.evidence_planes(); }),
      pixels("census_code_row", {62 * 3, 62 * 4 + 4 + 8}, [](ImageRows& d) { d.census(); }),
      pixels("ray_census_code_row", {24 * 3, 24 * 4 + 4 + 3},
             [](ImageRows& d) { d.ray_census(1); }),
      pixels("ray_census_code_row/3", {24 * 5, 24 * 4 + 4 + 6},
             [](ImageRows& d) { d.ray_census(3); }),
      pixels("sampling_bounds_row", {8, 20}, [](ImageRows& d) { d.bounds(); }),
  };
}

}  // namespace vantage::perf
