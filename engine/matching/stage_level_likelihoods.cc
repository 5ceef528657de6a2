#include "engine/matching/stage_level_likelihoods.h"

#include <cstddef>
#include <cstdint>

#include "engine/matching/column_work.h"
#include "engine/matching/level_stages.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage {
namespace {

class LikelihoodReductionStage final : public LevelReductionStage {
 public:
  using LevelReductionStage::LevelReductionStage;

  /// Of one block.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(float) * static_cast<std::size_t>(lanes());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kReduceLikelihoodsWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::reduce_likelihoods_row(blocks(task), reinterpret_cast<float*>(task.state),
                                    coarser().column<std::uint8_t>(task.columns.begin, task.y));
  }
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

class LevelProbabilityStage final : public LevelStoreStage {
 public:
  using LevelStoreStage::LevelStoreStage;

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kCompactProbabilitiesWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::compact_probabilities_row(cells(task), cell_count(task),
                                       volume().column<std::uint8_t>(task.columns.begin, task.y));
  }
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_likelihood_reduction_stage(
    const kernels::CandidateGeometry& geometry, LevelVolume& coarser) {
  return std::make_unique<LikelihoodReductionStage>(geometry, coarser);
}

void reduce_energy_row(const LevelVolume& finer, int y, LevelVolume& coarser) {
  kernels::reduce_compact_energies_row(block_row<std::uint8_t>(finer, y),
                                       coarser.column<std::uint8_t>(0, y));
}

std::unique_ptr<scheduler::RowStage> make_level_likelihood_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies) {
  return std::make_unique<LevelLikelihoodStage>(geometry, energies);
}

std::unique_ptr<scheduler::RowStage> make_level_probability_stage(
    const kernels::CandidateGeometry& geometry, LevelVolume& probabilities) {
  return std::make_unique<LevelProbabilityStage>(geometry, probabilities);
}

}  // namespace vantage
