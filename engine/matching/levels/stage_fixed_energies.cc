#include "engine/matching/levels/stage_fixed_energies.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/column_work.h"
#include "engine/matching/levels/level_stages.h"
#include "kernels/energy_winner/energy_winner.h"
#include "kernels/fixed_energies/fixed_energies.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;

class FixedEnergyStage final : public scheduler::RowStage {
 public:
  FixedEnergyStage(std::unique_ptr<scheduler::RowStage> costs, const EnergyConversion& conversion,
                   int count)
      : RowStage(costs->extent()),
        costs_(std::move(costs)),
        conversion_(conversion),
        lanes_(kernels::CandidateGeometry{.count = count}.lanes()),
        count_(count) {}

  [[nodiscard]] std::string_view name() const override { return costs_->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(FixedEnergy) * static_cast<std::size_t>(lanes_);
  }
  /// The costs of a few columns, and the working memory to compute them.
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return cost_bytes() + costs_->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    scheduler::ColumnWork work = costs_->column_work();
    const scheduler::ColumnWork own = vantage::column_work(conversion_.work(), count_);
    work.operations += own.operations;
    work.bytes += own.bytes;
    return work;
  }

  void make_row(const scheduler::RowTask& task) const override {
    scheduler::RowTask part = task;
    part.output = task.state;
    part.state = task.state + cost_bytes();
    auto* energies = reinterpret_cast<FixedEnergy*>(task.output);
    for (int x = task.columns.begin; x < task.columns.end; x = part.columns.end) {
      part.columns = {x, std::min(x + part_columns(), task.columns.end)};
      costs_->make_row(part);
      conversion_.convert(part.output, part.columns.size(), lanes_, count_, energies, lanes_);
      energies += static_cast<std::ptrdiff_t>(part.columns.size()) * lanes_;
    }
  }

 private:
  /// Columns that are still in the level-1 cache when they are read again.
  [[nodiscard]] int part_columns() const {
    constexpr std::size_t kPartBytes = 16384;
    constexpr std::size_t kMaxColumns = 32;
    return static_cast<int>(
        std::clamp<std::size_t>(kPartBytes / costs_->bytes_per_column(), 1, kMaxColumns));
  }
  [[nodiscard]] std::size_t cost_bytes() const {
    constexpr std::size_t kAlignment = 64;
    const std::size_t bytes = costs_->bytes_per_column() * static_cast<std::size_t>(part_columns());
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

  std::unique_ptr<scheduler::RowStage> costs_;
  EnergyConversion conversion_;
  int lanes_;
  int count_;
};

class LevelFixedEnergyStage final : public LevelSourceStage {
 public:
  LevelFixedEnergyStage(const kernels::CandidateGeometry& geometry, const LevelVolume& energies,
                        const EnergyFormat& format, const CandidateBlocks* blocks)
      : LevelSourceStage(geometry, energies),
        steps_(format.of_bytes(kernels::kEnergyStep)),
        blocks_(blocks) {}

  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(FixedEnergy) *
           static_cast<std::size_t>(blocks_ == nullptr ? lanes() : blocks_->lanes());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kFixedEnergiesOfBytesWork,
                                candidates_in(blocks_, count()));
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* energies = reinterpret_cast<FixedEnergy*>(task.output);
    if (blocks_ == nullptr) {
      kernels::fixed_energies_of_bytes_row(
          {.cells = volume().column<std::uint8_t>(task.columns.begin, task.y),
           .columns = task.columns.size(),
           .lanes = lanes(),
           .count = count()},
          steps_, energies);
      return;
    }
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      const std::uint8_t* const bytes = volume().column<std::uint8_t>(x, task.y);
      FixedEnergy* target = energies;
      for (const std::uint16_t block : run.blocks) {
        const int first = block * kernels::kLaneMultiple;
        kernels::fixed_energies_of_bytes_row(
            {.cells = bytes + first,
             .columns = run.columns.size(),
             .lanes = kernels::kLaneMultiple,
             .count = std::min(kernels::kLaneMultiple, count() - first)},
            steps_, target, {.cells = lanes(), .energies = blocks_->lanes()});
        target += kernels::kLaneMultiple;
      }
      energies += static_cast<std::ptrdiff_t>(run.columns.size()) * blocks_->lanes();
      x = run.columns.end;
    }
  }

 private:
  kernels::ByteSteps steps_;
  const CandidateBlocks* blocks_;
};

class LevelFixedEnergyResultStage final : public LevelStoreStage {
 public:
  LevelFixedEnergyResultStage(const kernels::CandidateGeometry& geometry, const LevelResult& result,
                              const EnergyFormat& format, const CandidateBlocks* blocks)
      : LevelStoreStage(geometry, *result.cells),
        bytes_per_step_(format.result_bytes_per_step()),
        winners_(result.winners),
        blocks_(blocks) {}

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work = kernels::kBytesOfFixedEnergiesWork;
    if (winners_ != nullptr) {
      work = work + kernels::energy_winner_work();
    }
    return vantage::column_work(work, candidates_in(blocks_, count()));
  }

  void make_row(const scheduler::RowTask& task) const override {
    kernels::bytes_of_fixed_energies_row(cells<FixedEnergy>(task, task.columns.begin),
                                         cell_count(task), bytes_per_step_,
                                         volume().column<std::uint8_t>(task.columns.begin, task.y));
    if (winners_ == nullptr) {
      return;
    }
    if (blocks_ == nullptr) {
      write_winners(task, task.columns, count());
      return;
    }
    for (int x = task.columns.begin; x < task.columns.end;) {
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      std::int32_t* const winners = write_winners(task, run.columns, blocks_->count(run.blocks));
      std::transform(winners, winners + run.columns.size(), winners,
                     [&run](std::int32_t lane) { return candidate_of(run.blocks, lane); });
      x = run.columns.end;
    }
  }

 private:
  /// The lanes with the smallest energies: all `count` candidates can win, with or without a
  /// partner.
  std::int32_t* write_winners(const scheduler::RowTask& task, scheduler::Range columns,
                              int count) const {
    kernels::EnergyRow row;
    row.geometry = {.width = columns.size() + 2 * count, .disparity_min = 0, .count = count};
    row.first_column = count;
    row.pitch = volume().lanes();
    std::int32_t* const winners = winners_->row(task.y) + columns.begin;
    std::array<FixedEnergy, CandidateBlocks::kMaxRunColumns> min;
    for (int x = columns.begin; x < columns.end; x += row.columns) {
      row.cells = cells<FixedEnergy>(task, x);
      row.columns = std::min(CandidateBlocks::kMaxRunColumns, columns.end - x);
      kernels::select_energy_winners_row(row, winners + (x - columns.begin), min.data());
    }
    return winners;
  }

  kernels::FixedWeight bytes_per_step_;
  Image<std::int32_t>* winners_;
  const CandidateBlocks* blocks_;
};

}  // namespace

void EnergyConversion::convert(const std::byte* cells, int columns, int lanes, int count,
                               FixedEnergy* energies, std::ptrdiff_t pitch) const {
  const kernels::EnergyPitches pitches{.energies = pitch};
  if (source_ == EnergySource::kBytes) {
    kernels::fixed_energies_of_bytes_row({.cells = reinterpret_cast<const std::uint8_t*>(cells),
                                          .columns = columns,
                                          .lanes = lanes,
                                          .count = count},
                                         byte_steps_, energies, pitches);
  } else {
    kernels::fixed_energies_of_likelihoods_row({.cells = reinterpret_cast<const float*>(cells),
                                                .columns = columns,
                                                .lanes = lanes,
                                                .count = count},
                                               steps_per_nat_, energies, pitches);
  }
}

kernels::KernelWork EnergyConversion::work() const {
  return source_ == EnergySource::kBytes ? kernels::kFixedEnergiesOfBytesWork
                                         : kernels::kFixedEnergiesOfLikelihoodsWork;
}

std::unique_ptr<scheduler::RowStage> make_fixed_energy_stage(
    std::unique_ptr<scheduler::RowStage> costs, const EnergyConversion& conversion, int count) {
  return std::make_unique<FixedEnergyStage>(std::move(costs), conversion, count);
}

std::unique_ptr<scheduler::RowStage> make_level_fixed_energy_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies,
    const EnergyFormat& format, const CandidateBlocks* blocks) {
  return std::make_unique<LevelFixedEnergyStage>(geometry, energies, format, blocks);
}

std::unique_ptr<scheduler::RowStage> make_level_fixed_energy_result_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result,
    const EnergyFormat& format, const CandidateBlocks* blocks) {
  return std::make_unique<LevelFixedEnergyResultStage>(geometry, result, format, blocks);
}

}  // namespace vantage
