#include "engine/matching/levels/stage_half_energies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/column_work.h"
#include "engine/matching/levels/level_stages.h"
#include "kernels/half_energies/half_energies.h"

namespace vantage {
namespace {

class EnergyReductionStage final : public LevelReductionStage {
 public:
  EnergyReductionStage(const kernels::CandidateGeometry& geometry, float scale,
                       LevelVolume& coarser)
      : LevelReductionStage(geometry, coarser), scale_(scale) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kReduceEnergiesWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::reduce_energies_row(blocks<float>(task), scale_,
                                 coarser().column<std::uint16_t>(task.columns.begin, task.y));
  }

 private:
  float scale_;
};

class LevelHalfEnergyStage final : public LevelSourceStage {
 public:
  LevelHalfEnergyStage(const kernels::CandidateGeometry& geometry, float scale,
                       const LevelVolume& energies)
      : LevelSourceStage(geometry, energies), unit_(1 / scale) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kExpandHalfWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::energies_of_half_row(volume().column<std::uint16_t>(task.columns.begin, task.y),
                                  task.columns.size() * lanes(), unit_,
                                  reinterpret_cast<float*>(task.output));
  }

 private:
  float unit_;
};

class EnergyStoreStage final : public LevelStoreStage {
 public:
  EnergyStoreStage(const kernels::CandidateGeometry& geometry, float scale, LevelVolume& energies)
      : LevelStoreStage(geometry, energies), scale_(scale) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kHalfEnergiesWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::half_energies_row(cells<float>(task, task.columns.begin), cell_count(task), scale_,
                               volume().column<std::uint16_t>(task.columns.begin, task.y));
  }

 private:
  float scale_;
};

class CoarserEnergyStage final : public scheduler::RowStage {
 public:
  CoarserEnergyStage(const kernels::CandidateGeometry& geometry, int height, CoarserUse use,
                     float scale, const LevelVolume& coarser)
      : RowStage({geometry.width, height}),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        use_(use),
        unit_(1 / scale),
        coarser_(coarser) {}

  [[nodiscard]] std::string_view name() const override {
    return use_ == CoarserUse::kStart ? "start from coarser" : "support of coarser";
  }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(lanes_);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        use_ == CoarserUse::kStart ? kernels::kExpandHalfWork : kernels::kCoarserSupportWork,
        count_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    const kernels::CoarserRow row{
        .coarser = coarser_.column<std::uint16_t>(task.columns.begin / 2, task.y / 2),
        .first_column = task.columns.begin,
        .columns = task.columns.size(),
        .lanes = lanes_,
        .unit = unit_};
    auto* output = reinterpret_cast<float*>(task.output);
    if (use_ == CoarserUse::kStart) {
      kernels::energies_from_coarser_row(row, output);
    } else {
      const float* own =
          task.input.row<float>(task.y) +
          static_cast<std::ptrdiff_t>(task.columns.begin - task.input.columns().begin) * lanes_;
      kernels::energies_with_coarser_row(row, own, output);
    }
  }

 private:
  int lanes_;
  int count_;
  CoarserUse use_;
  float unit_;
  const LevelVolume& coarser_;
};

}  // namespace

float half_scale(const CostBounds& bounds) {
  constexpr float kLargest = 32768;
  const float largest = std::max({1.0F, std::abs(bounds.min), std::abs(bounds.max)});
  float scale = 1;
  while (largest * scale > kLargest) {
    scale /= 2;
  }
  return scale;
}

std::unique_ptr<scheduler::RowStage> make_half_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& coarser) {
  return std::make_unique<EnergyReductionStage>(geometry, scale, coarser);
}

void reduce_half_energy_row(const LevelVolume& finer, int y, LevelVolume& coarser) {
  kernels::reduce_half_energies_row(block_row<std::uint16_t>(finer, y),
                                    coarser.column<std::uint16_t>(0, y));
}

std::unique_ptr<scheduler::RowStage> make_level_half_energy_stage(
    const kernels::CandidateGeometry& geometry, float scale, const LevelVolume& energies) {
  return std::make_unique<LevelHalfEnergyStage>(geometry, scale, energies);
}

std::unique_ptr<scheduler::RowStage> make_coarser_half_energy_stage(
    const kernels::CandidateGeometry& geometry, int height, CoarserUse use, float scale,
    const LevelVolume& coarser) {
  return std::make_unique<CoarserEnergyStage>(geometry, height, use, scale, coarser);
}

std::unique_ptr<scheduler::RowStage> make_half_energy_store_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& energies) {
  return std::make_unique<EnergyStoreStage>(geometry, scale, energies);
}

}  // namespace vantage
