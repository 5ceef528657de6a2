#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/mean_energy/mean_energy.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag64 = hn::ScalableTag<double>;
using Tag32 = hn::Rebind<std::int32_t, Tag64>;
using TagF = hn::Rebind<float, Tag64>;

HWY_INLINE hn::VFromD<TagF> means(const WinnerRow& row, const std::int32_t* cells,
                                  hn::VFromD<Tag64> factor, double offset) {
  const Tag64 d64;
  const auto sums = hn::ShiftRightSame(hn::LoadU(Tag32(), cells), row.index_bits);
  return hn::DemoteTo(TagF(),
                      hn::Sub(hn::Mul(hn::PromoteTo(d64, sums), factor), hn::Set(d64, offset)));
}

// A column whose candidates all have the same number of samples.
HWY_INLINE void plain_column(const WinnerRow& row, const EnergyUnit& unit, int x,
                             const std::int32_t* cells, float* energies) {
  const Tag64 d64;
  const int lanes = row.geometry.lanes();
  const int count = row.geometry.count;
  const int samples = unit.window_rows * row.full_window_columns(x);
  const auto factor = hn::Set(d64, unit.scale / samples);
  for (int i = 0; i < lanes; i += static_cast<int>(hn::Lanes(d64))) {
    hn::StoreU(means(row, cells + i, factor, unit.offset), TagF(), energies + i);
  }
  std::fill(energies + count, energies + lanes, 0.0F);
}

// Any column: between neighbouring candidates the window may lose or gain a column.
HWY_INLINE void border_column(const WinnerRow& row, const EnergyUnit& unit, int x,
                              const std::int32_t* cells, float* energies) {
  const Tag64 d64;
  const Tag32 d32;
  const int lanes = row.geometry.lanes();
  const CandidateRange candidates = row.candidates(x);
  if (candidates.empty()) {
    std::fill_n(energies, lanes, 0.0F);
    return;
  }
  if (row.geometry.steps_per_px > 1 || !row.geometry.is_of_one()) {
    std::fill_n(energies, lanes, 0.0F);
    for (int i = candidates.begin; i < candidates.end; ++i) {
      const double factor = unit.scale / (unit.window_rows * row.window_columns(x, i));
      energies[i] = static_cast<float>(row.sum(cells[i]) * factor - unit.offset);
    }
    return;
  }
  // WinnerRow::window_columns() for neighbouring candidates.
  const int last_column = row.geometry.width - 1;
  const auto first = hn::Set(d32, std::max(x - row.window_radius, 0));
  const auto last = hn::Set(d32, std::min(x + row.window_radius, last_column));
  const auto shifts_per_lane = hn::Set(d32, -row.geometry.direction);
  const auto window_rows = hn::Set(d64, unit.window_rows);
  for (int i = 0; i < lanes; i += static_cast<int>(hn::Lanes(d64))) {
    const auto shift = hn::Add(hn::Set(d32, x - row.geometry.partner(x, i)),
                               hn::Mul(hn::Iota(d32, 0), shifts_per_lane));
    const auto columns =
        hn::Sub(hn::Min(last, hn::Add(hn::Set(d32, last_column), shift)), hn::Max(first, shift));
    // Lanes without a candidate may have no samples; their results are discarded.
    const auto samples =
        hn::Mul(window_rows, hn::PromoteTo(d64, hn::Add(columns, hn::Set(d32, 1))));
    const auto factor = hn::Div(hn::Set(d64, unit.scale), samples);
    hn::StoreU(means(row, cells + i, factor, unit.offset), TagF(), energies + i);
  }
  std::fill(energies, energies + candidates.begin, 0.0F);
  std::fill(energies + candidates.end, energies + lanes, 0.0F);
}

void mean_energy_row_simd(const WinnerRow& row, const EnergyUnit& unit,
                          float* HWY_RESTRICT energies) {
  const int lanes = row.geometry.lanes();
  const auto [plain_begin, plain_end] = row.plain_columns();
  const std::int32_t* cells = row.cells;
  for (int j = 0; j < row.columns; ++j, cells += lanes, energies += lanes) {
    const int x = row.first_column + j;
    if (x >= plain_begin && x < plain_end) {
      plain_column(row, unit, x, cells, energies);
    } else {
      border_column(row, unit, x, cells, energies);
    }
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(mean_energy_row_simd);

void mean_energy_row(const WinnerRow& row, const EnergyUnit& unit, float* energies) {
  HWY_DYNAMIC_DISPATCH(mean_energy_row_simd)(row, unit, energies);
}

// Uses the same factor for the same number of samples, so that equal sums give equal energies.
static float mean_energy(const WinnerRow& row, const EnergyUnit& unit, int x, std::int32_t cell,
                         int candidate) {
  const double factor = unit.scale / (unit.window_rows * row.window_columns(x, candidate));
  return static_cast<float>(row.sum(cell) * factor - unit.offset);
}

void winner_energy_row(const WinnerRow& row, const EnergyUnit& unit, const std::int32_t* winners,
                       float* energy) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  for (int j = 0; j < row.columns; ++j) {
    energy[j] = winners[j] == kNoWinner
                    ? std::numeric_limits<float>::quiet_NaN()
                    : mean_energy(row, unit, row.first_column + j,
                                  row.cells[j * lanes + winners[j]], winners[j]);
  }
}

}  // namespace vantage::kernels
#endif
