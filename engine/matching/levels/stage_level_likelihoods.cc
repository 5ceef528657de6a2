#include "engine/matching/levels/stage_level_likelihoods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "engine/column_work.h"
#include "engine/matching/levels/level_stages.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/pair_reduction/pair_reduction.h"

namespace vantage {
namespace {

class LikelihoodReductionStage final : public LevelReductionStage {
 public:
  LikelihoodReductionStage(const kernels::CandidateGeometry& geometry, float weight,
                           LevelVolume& coarser)
      : LevelReductionStage(geometry, coarser), weight_(weight) {}

  /// One block.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) * static_cast<std::size_t>(lanes());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kReduceLikelihoodsWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::reduce_likelihoods_row(blocks<float>(task), weight_,
                                    reinterpret_cast<float*>(task.state),
                                    coarser().column<std::uint8_t>(task.columns.begin, task.y));
  }

 private:
  float weight_;
};

/// Of sums in steps of `step`, relative to compact ones.
float compact_weight(float step, float weight) { return weight * (step / kernels::kEnergyStep); }

class ByteEnergyReductionStage final : public LevelReductionStage {
 public:
  ByteEnergyReductionStage(const kernels::CandidateGeometry& geometry, float step, float weight,
                           LevelVolume& coarser)
      : LevelReductionStage(geometry, coarser), weight_(compact_weight(step, weight)) {}

  /// One block.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(std::uint16_t) * static_cast<std::size_t>(lanes());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kReduceCompactEnergiesWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::reduce_compact_energies_row(
        blocks<std::uint8_t>(task), weight_, reinterpret_cast<std::uint16_t*>(task.state),
        coarser().column<std::uint8_t>(task.columns.begin, task.y));
  }

 private:
  float weight_;
};

class PairEnergyReductionStage final : public scheduler::RowStage {
 public:
  PairEnergyReductionStage(std::unique_ptr<scheduler::RowStage> costs,
                           const kernels::CandidateGeometry& geometry, std::uint8_t without_partner,
                           float step, float weight, const PairLevels& levels)
      : RowStage(coarser_extent(costs->extent())),  // plans have no levels yet
        costs_(std::move(costs)),
        geometry_(geometry),
        without_partner_(without_partner),
        weight_(compact_weight(step, weight)),
        levels_(levels) {}

  [[nodiscard]] std::string_view name() const override { return "reduce"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] bool needs_whole_rows() const override { return true; }
  /// What is kept of a row, the costs of a part of two rows, and the memory to compute them.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return row_bytes() + 2 * part_bytes() + costs_->state_bytes(columns, input);
  }
  /// Of one block.
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const scheduler::ColumnWork costs = costs_->column_work();
    scheduler::ColumnWork work =
        vantage::column_work(kernels::kReducePairEnergiesWork, geometry_.count);
    work.operations += 4 * costs.operations;
    work.bytes += 4 * costs.bytes;
    return work;
  }

  void make_row(const scheduler::RowTask& task) const override {
    const int lanes = geometry_.lanes();
    const kernels::PairRow row{.columns = geometry_.width,
                               .lanes = lanes,
                               .disparity_min = geometry_.disparity_min,
                               .count = geometry_.count,
                               .without_partner = without_partner_,
                               .weight = weight_,
                               .work = reinterpret_cast<std::uint16_t*>(task.state)};
    std::byte* const upper = task.state + row_bytes();
    const bool has_lower = 2 * task.y + 1 < costs_->extent().rows;
    std::byte* const lower = has_lower ? upper + part_bytes() : upper;
    scheduler::RowTask part = task;
    part.state = task.state + row_bytes() + 2 * part_bytes();
    kernels::start_pair_row(row);
    for (int x = 0; x < geometry_.width; x = part.columns.end) {
      part.columns = {x, std::min(x + part_columns(), geometry_.width)};
      part.y = 2 * task.y;
      part.output = upper;
      costs_->make_row(part);
      if (has_lower) {
        ++part.y;
        part.output = lower;
        costs_->make_row(part);
      }
      kernels::reduce_left_part(row,
                                {.upper = reinterpret_cast<const std::uint8_t*>(upper),
                                 .lower = reinterpret_cast<const std::uint8_t*>(lower),
                                 .columns = part.columns.size(),
                                 .lanes = lanes},
                                x, levels_.left.column<std::uint8_t>(x / 2, task.y));
    }
    kernels::reduce_right_row(row, levels_.right.column<std::uint8_t>(0, task.y));
  }

 private:
  /// An even number, whose costs are still in the level-1 cache when they are read.
  [[nodiscard]] int part_columns() const {
    constexpr int kPartBytes = 8192;
    constexpr int kMaxColumns = 64;
    return std::clamp(kPartBytes / geometry_.lanes() / 2 * 2, 2, kMaxColumns);
  }
  static std::size_t aligned(std::size_t bytes) { return (bytes + 63) / 64 * 64; }
  [[nodiscard]] std::size_t part_bytes() const {
    return aligned(static_cast<std::size_t>(part_columns()) * costs_->bytes_per_column());
  }
  [[nodiscard]] std::size_t row_bytes() const {
    return aligned(sizeof(std::uint16_t) * kernels::pair_row_work(geometry_.width,
                                                                  geometry_.lanes(),
                                                                  geometry_.disparity_min));
  }

  std::unique_ptr<scheduler::RowStage> costs_;
  kernels::CandidateGeometry geometry_;
  std::uint8_t without_partner_;
  float weight_;
  PairLevels levels_;
};

class LevelLikelihoodStage final : public LevelSourceStage {
 public:
  using LevelSourceStage::LevelSourceStage;

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kExpandCompactWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::likelihoods_of_compact_row(
        {.cells = volume().column<std::uint8_t>(task.columns.begin, task.y),
         .columns = task.columns.size(),
         .lanes = lanes(),
         .count = count()},
        reinterpret_cast<float*>(task.output));
  }
};

/// The candidates with the largest cells, among all `count`, with or without a partner.
void write_winners(const float* cells, int columns, int count, std::int32_t* winners) {
  kernels::CellRow row;
  row.cells = cells;
  row.geometry = {.width = columns + 2 * count, .disparity_min = 0, .count = count};
  row.first_column = count;
  row.columns = columns;
  row.probabilities = true;
  kernels::select_cell_winners_row(row, {.winners = winners});
}

class LevelProbabilityStage final : public LevelStoreStage {
 public:
  LevelProbabilityStage(const kernels::CandidateGeometry& geometry, const LevelResult& result)
      : LevelStoreStage(geometry, *result.cells), winners_(result.winners) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work = kernels::kCompactProbabilitiesWork;
    if (winners_ != nullptr) {
      work = work + kernels::cell_winner_work(true, false);
    }
    return vantage::column_work(work, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    const int x = task.columns.begin;
    kernels::compact_probabilities_row(cells<float>(task, x), cell_count(task),
                                       volume().column<std::uint8_t>(x, task.y));
    if (winners_ != nullptr) {
      write_winners(cells<float>(task, x), task.columns.size(), count(), winners_->row(task.y) + x);
    }
  }

 private:
  Image<std::int32_t>* winners_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_likelihood_reduction_stage(
    const kernels::CandidateGeometry& geometry, float weight, LevelVolume& coarser) {
  return std::make_unique<LikelihoodReductionStage>(geometry, weight, coarser);
}

std::unique_ptr<scheduler::RowStage> make_byte_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float step, float weight, LevelVolume& coarser) {
  return std::make_unique<ByteEnergyReductionStage>(geometry, step, weight, coarser);
}

std::unique_ptr<scheduler::RowStage> make_pair_energy_reduction_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    std::uint8_t without_partner, float step, float weight, const PairLevels& levels) {
  return std::make_unique<PairEnergyReductionStage>(std::move(costs), geometry, without_partner,
                                                    step, weight, levels);
}

void reduce_float_energy_row(const LevelVolume& finer, int y, scheduler::Range columns,
                             const EnergyReduction& reduction, std::uint16_t* work,
                             LevelVolume& coarser) {
  auto row = block_row<std::uint8_t>(finer, y);
  row.columns = std::min(2 * columns.end, row.columns) - 2 * columns.begin;
  row.upper = finer.column<std::uint8_t>(2 * columns.begin, 2 * y);
  row.lower += row.upper - finer.column<std::uint8_t>(0, 2 * y);
  auto* const energies = coarser.column<std::uint8_t>(columns.begin, y);
  kernels::reduce_compact_energies_row(row, reduction.weight, work, energies);
  const double steps = std::nearbyint(reduction.slant_penalty / kernels::kEnergyStep);
  if (steps < kernels::kMaxCompact) {
    kernels::allow_slant_row(energies, columns.size(), coarser.lanes(),
                             static_cast<std::uint8_t>(steps));
  }
}

std::unique_ptr<scheduler::RowStage> make_level_likelihood_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies) {
  return std::make_unique<LevelLikelihoodStage>(geometry, energies);
}

std::unique_ptr<scheduler::RowStage> make_level_probability_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result) {
  return std::make_unique<LevelProbabilityStage>(geometry, result);
}

}  // namespace vantage
