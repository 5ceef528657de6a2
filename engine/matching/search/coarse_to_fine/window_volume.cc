#include "engine/matching/search/coarse_to_fine/window_volume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace vantage {
namespace {

/// Values of the candidates of a window. `values`: those of its column.
void write_window(const WindowState& state, int x, int y, int count, bool are_probabilities,
                  float* values) {
  const kernels::WindowCells support = state.support.at(x, y);
  const int start = state.start.at(x, y);
  const int lanes = std::min(kernels::kWindowCandidates, count - start);
  const int winner = state.winner.at(x, y) - start;
  // Cells are rounded: of those that are equal to the winner's, none was larger.
  constexpr double kTie = 0.25;
  const auto nats = [&](int k) {
    const int cell = kernels::window_cell(support, k);
    const bool is_tie = k != winner && cell == kernels::window_cell(support, winner);
    return (state.ceiling - cell + (is_tie ? kTie : 0)) * state.nats_per_step;
  };
  double sum = 0;
  for (int k = 0; are_probabilities && k < lanes; ++k) {
    sum += std::exp(-nats(k));
  }
  for (int k = 0; k < lanes; ++k) {
    values[start + k] = static_cast<float>(are_probabilities ? std::exp(-nats(k)) / sum : nats(k));
  }
}

}  // namespace

void write_window_volume(const WindowState& state, int count, const VolumeWriter& writer,
                         Execution& execution) {
  const int width = state.winner.width();
  const bool are_probabilities = writer.shape().content == VolumeContent::kProbabilities;
  execution.for_each_band(state.winner.height(), [&](int first_row, int end_row) {
    std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(count));
    std::vector<float> work(writer.work_floats());
    for (int y = first_row; y < end_row; ++y) {
      std::ranges::fill(values, std::numeric_limits<float>::quiet_NaN());
      for (int x = 0; x < width; ++x) {
        write_window(state, x, y, count, are_probabilities,
                     values.data() + static_cast<std::ptrdiff_t>(x) * count);
      }
      writer.write_values({.cells = values.data(), .pitch = count, .x = 0, .y = y, .count = width},
                          work.data());
    }
  });
}

}  // namespace vantage
