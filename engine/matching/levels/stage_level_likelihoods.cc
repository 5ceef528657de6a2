#include "engine/matching/levels/stage_level_likelihoods.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/column_work.h"
#include "engine/matching/levels/level_stages.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

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

class ByteEnergyReductionStage final : public LevelReductionStage {
 public:
  ByteEnergyReductionStage(const kernels::CandidateGeometry& geometry, float step, float weight,
                           LevelVolume& coarser)
      : LevelReductionStage(geometry, coarser), weight_(weight * (step / kernels::kEnergyStep)) {}

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
  float weight_;  ///< of sums in steps of `step`, relative to compact ones
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

void reduce_float_energy_row(const LevelVolume& finer, int y, scheduler::Range columns,
                             float weight, std::uint16_t* work, LevelVolume& coarser) {
  auto row = block_row<std::uint8_t>(finer, y);
  row.columns = std::min(2 * columns.end, row.columns) - 2 * columns.begin;
  row.upper = finer.column<std::uint8_t>(2 * columns.begin, 2 * y);
  row.lower += row.upper - finer.column<std::uint8_t>(0, 2 * y);
  kernels::reduce_compact_energies_row(row, weight, work,
                                       coarser.column<std::uint8_t>(columns.begin, y));
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
