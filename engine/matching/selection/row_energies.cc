#include "engine/matching/selection/row_energies.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/error.h"
#include "kernels/energy_winner/energy_winner.h"
#include "kernels/mean_energy/mean_energy.h"
#include "kernels/row_sum/row_sum.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using scheduler::InputRows;
using scheduler::Range;

/// −ln of the smallest normal float, about.
constexpr float kMaxNats = 87;

class CellEnergies final : public RowEnergies {
 public:
  CellEnergies(const kernels::CandidateGeometry& geometry, bool are_probabilities)
      : RowEnergies(geometry), are_probabilities_(are_probabilities) {}

  [[nodiscard]] std::size_t work_bytes() const override {
    return are_probabilities_ ? sizeof(float) * row_floats() : 0;
  }
  [[nodiscard]] kernels::KernelWork work() const override {
    return are_probabilities_ ? kernels::cell_work(kernels::kDoubleLogOperations + 1)
                              : kernels::KernelWork{};
  }
  [[nodiscard]] kernels::CellRow energies(const InputRows& input, int y,
                                          std::byte* work) const override {
    const auto* cells = input.row<float>(y);
    if (!are_probabilities_) {
      return row_of(cells);
    }
    auto* const energies = reinterpret_cast<float*>(work);
    const auto floats = static_cast<std::ptrdiff_t>(row_floats());
    kernels::probability_energy_row(cells, static_cast<int>(floats), energies);
    std::transform(energies, energies + floats, energies,
                   [](float energy) { return std::min(energy, kMaxNats); });
    return row_of(energies);
  }
  void probabilities(const InputRows& input, int y, Range columns, const std::int32_t* winners,
                     float* probability) const override {
    const std::ptrdiff_t lanes = geometry().lanes();
    const auto* cells = input.row<float>(y);
    for (int x = columns.begin; x < columns.end; ++x) {
      probability[x - columns.begin] = winners[x] == kernels::kNoWinner
                                           ? std::numeric_limits<float>::quiet_NaN()
                                           : cells[x * lanes + winners[x]];
    }
  }

 private:
  bool are_probabilities_;
};

class FixedRowEnergies final : public RowEnergies {
 public:
  FixedRowEnergies(const kernels::CandidateGeometry& geometry, float steps_per_nat)
      : RowEnergies(geometry), steps_per_nat_(steps_per_nat) {}

  [[nodiscard]] std::size_t work_bytes() const override { return sizeof(float) * row_floats(); }
  [[nodiscard]] kernels::KernelWork work() const override { return {1, 0, 1 + 0.5, 0}; }
  [[nodiscard]] kernels::CellRow energies(const InputRows& input, int y,
                                          std::byte* work) const override {
    const auto* cells = input.row<FixedEnergy>(y);
    auto* const energies = reinterpret_cast<float*>(work);
    const float nats_per_step = 1 / steps_per_nat_;
    std::transform(cells, cells + row_floats(), energies, [nats_per_step](FixedEnergy energy) {
      return nats_per_step * static_cast<float>(energy);
    });
    return row_of(energies);
  }
  void probabilities(const InputRows& input, int y, Range columns, const std::int32_t* winners,
                     float* probability) const override {
    constexpr int kBlockColumns = 32;
    const std::ptrdiff_t lanes = geometry().lanes();
    const auto* cells = input.row<FixedEnergy>(y);
    std::array<FixedEnergy, kBlockColumns> selected;
    for (int first = columns.begin; first < columns.end; first += kBlockColumns) {
      const int count = std::min(kBlockColumns, columns.end - first);
      for (int j = 0; j < count; ++j) {
        const int winner = winners[first + j];
        selected[static_cast<std::size_t>(j)] = winner == kernels::kNoWinner
                                                    ? kernels::kMaxEnergy
                                                    : cells[(first + j) * lanes + winner];
      }
      kernels::energy_probability_row({.cells = cells + first * lanes,
                                       .pitch = lanes,
                                       .columns = count,
                                       .lanes = geometry().lanes()},
                                      selected.data(), steps_per_nat_,
                                      probability + (first - columns.begin));
    }
  }

 private:
  float steps_per_nat_;
};

class WindowEnergies final : public RowEnergies {
 public:
  WindowEnergies(const kernels::CandidateGeometry& geometry, int height,
                 const WindowSelectionSettings& settings)
      : RowEnergies(geometry), height_(height), settings_(settings) {}

  /// Energies of the row; window sums of a block, and those that run from block to block; and what
  /// the writer of a volume needs.
  [[nodiscard]] std::size_t work_bytes() const override {
    return sizeof(float) * row_floats() +
           sizeof(std::int32_t) * (kBlockColumns + 1) * static_cast<std::size_t>(lanes()) +
           (settings_.volume != nullptr ? sizeof(float) * settings_.volume->work_floats() : 0);
  }
  [[nodiscard]] kernels::KernelWork work() const override {
    return kernels::row_sum_work(true) + kernels::kMeanEnergyWork;
  }
  [[nodiscard]] kernels::CellRow energies(const InputRows& input, int y,
                                          std::byte* work) const override {
    auto* const energies = reinterpret_cast<float*>(work);
    if (has_whole_windows() && (y < settings_.radius || y >= height_ - settings_.radius)) {
      if (settings_.volume != nullptr) {
        settings_.volume->write_nothing(0, y, geometry().width, energies);
      }
      return row_of(energies, geometry().width);  // no candidate counts
    }
    auto* const sums = reinterpret_cast<std::int32_t*>(energies + row_floats());
    kernels::RowSum sum;
    sum.input = input.row<std::int32_t>(y);
    sum.input_end = geometry().width;
    sum.radius = settings_.radius;
    sum.lanes = lanes();
    sum.window_sums = sums + kBlockColumns * lanes();
    sum.output = sums;
    kernels::WinnerRow row;
    row.cells = sums;
    row.geometry = geometry();
    row.window_radius = settings_.radius;
    row.index_bits = settings_.index_bits;
    row.whole_windows_only = has_whole_windows();
    const Range window_rows = Range{y, y + 1}.widened(settings_.radius, {0, height_});
    const kernels::EnergyUnit unit{window_rows.size(), settings_.energy_scale,
                                   settings_.energy_offset};
    for (int x = 0; x < geometry().width; x += kBlockColumns) {
      sum.output_begin = x;
      sum.output_end = std::min(x + kBlockColumns, geometry().width);
      sum.continues = x > 0;
      kernels::row_sum(sum);
      row.first_column = x;
      row.columns = sum.output_end - x;
      kernels::mean_energy_row(row, unit, energies + static_cast<std::ptrdiff_t>(x) * lanes());
    }
    if (settings_.volume != nullptr) {
      settings_.volume->write_values(
          {.cells = energies, .pitch = lanes(), .y = y, .count = geometry().width},
          reinterpret_cast<float*>(sum.window_sums + lanes()));
    }
    return row_of(energies, has_whole_windows() ? settings_.radius : 0);
  }

 private:
  static constexpr int kBlockColumns = 32;

  [[nodiscard]] int lanes() const { return geometry().lanes(); }
  [[nodiscard]] bool has_whole_windows() const { return settings_.border == Border::kValid; }

  int height_;
  WindowSelectionSettings settings_;
};

}  // namespace

void RowEnergies::probabilities(const InputRows& /*input*/, int /*y*/, Range /*columns*/,
                                const std::int32_t* /*winners*/, float* /*probability*/) const {
  throw Error(
      "confidence is a probability, expected a measure of energies: evidence, margin or "
      "entropy");
}

std::unique_ptr<RowEnergies> make_cell_energies(const kernels::CandidateGeometry& geometry,
                                                bool cells_are_probabilities) {
  return std::make_unique<CellEnergies>(geometry, cells_are_probabilities);
}

std::unique_ptr<RowEnergies> make_fixed_energies(const kernels::CandidateGeometry& geometry,
                                                 float steps_per_nat) {
  return std::make_unique<FixedRowEnergies>(geometry, steps_per_nat);
}

std::unique_ptr<RowEnergies> make_window_energies(const kernels::CandidateGeometry& geometry,
                                                  int height,
                                                  const WindowSelectionSettings& settings) {
  return std::make_unique<WindowEnergies>(geometry, height, settings);
}

}  // namespace vantage
