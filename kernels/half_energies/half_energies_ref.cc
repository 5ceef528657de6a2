#include <cstddef>

#include "kernels/half_energies/half_energies.h"

namespace vantage::kernels {
namespace {

/// Writes the mean of the four columns of each block, read by `value` and times `scale`, as half
/// floats.
template <typename Cell, typename Value>
void reduce(const BlockRow<Cell>& row, float scale, const Value& value, std::uint16_t* halves) {
  for (int b = 0; b < row.blocks(); ++b) {
    for (int lane = 0; lane < row.lanes; ++lane) {
      const float upper =
          value(row.upper[row.left(b) + lane]) + value(row.upper[row.right(b) + lane]);
      const float lower =
          value(row.lower[row.left(b) + lane]) + value(row.lower[row.right(b) + lane]);
      halves[b * row.lanes + lane] = to_half((upper + lower) * (scale / 4));
    }
  }
}

float coarser_energy(const CoarserRow& row, int column, int lane) {
  const int block = (row.first_column + column) / 2 - row.first_column / 2;
  return of_half(row.coarser[block * row.lanes + lane]) * row.unit;
}

}  // namespace

void half_energies_row_ref(const float* energies, int cells, float scale, std::uint16_t* halves) {
  for (int k = 0; k < cells; ++k) {
    halves[k] = to_half(energies[k] * scale);
  }
}

void energies_of_half_row_ref(const std::uint16_t* halves, int cells, float unit, float* energies) {
  for (int k = 0; k < cells; ++k) {
    energies[k] = of_half(halves[k]) * unit;
  }
}

void reduce_energies_row_ref(const BlockRow<float>& row, float scale, std::uint16_t* halves) {
  reduce(
      row, scale, [](float energy) { return energy; }, halves);
}

void reduce_half_energies_row_ref(const BlockRow<std::uint16_t>& row, std::uint16_t* halves) {
  reduce(row, 1, of_half, halves);
}

void energies_from_coarser_row_ref(const CoarserRow& row, float* output) {
  for (int x = 0; x < row.columns; ++x) {
    for (int lane = 0; lane < row.lanes; ++lane) {
      output[x * row.lanes + lane] = coarser_energy(row, x, lane);
    }
  }
}

void energies_with_coarser_row_ref(const CoarserRow& row, const float* own, float* output) {
  for (int x = 0; x < row.columns; ++x) {
    for (int lane = 0; lane < row.lanes; ++lane) {
      const int k = x * row.lanes + lane;
      output[k] = 0.5F * (own[k] + coarser_energy(row, x, lane));
    }
  }
}

}  // namespace vantage::kernels
