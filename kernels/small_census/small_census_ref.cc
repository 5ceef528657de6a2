#include <bit>
#include <cstddef>
#include <limits>

#include "kernels/small_census/small_census.h"

namespace vantage::kernels {
namespace {

/// Of all channels together.
int distance(const SmallCensusPairs& row, int column, int lane) {
  int different = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [reference, partner] = row.channel[static_cast<std::size_t>(c)];
    for (std::size_t p = 0; p < kSmallCensusBytes; ++p) {
      different += std::popcount(static_cast<std::uint8_t>(
          reference[p][column] ^ partner[p][column * row.partner_step + lane]));
    }
  }
  return different;
}

/// cell(column, lane) of all cells.
template <typename Value, typename Cell>
void each_cell(const SmallCensusPairs& row, Value* cells, const Cell& cell) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      cells[j * row.lanes + i] = cell(j, i);
    }
  }
}

}  // namespace

LikelihoodByDistance::LikelihoodByDistance(
    const std::array<float, kSmallCensusDistances>& likelihoods) {
  for (std::size_t i = 0; i < likelihoods.size(); ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(likelihoods[i]);
    for (std::size_t b = 0; b < bytes_.size(); ++b) {
      bytes_[b][i] = static_cast<std::uint8_t>(bits >> (8 * b));
    }
  }
}

float LikelihoodByDistance::at(int distance) const {
  std::uint32_t bits = 0;
  for (std::size_t b = 0; b < bytes_.size(); ++b) {
    bits |= std::uint32_t{bytes_[b][static_cast<std::size_t>(distance)]} << (8 * b);
  }
  return std::bit_cast<float>(bits);
}

void small_hamming_row_ref(const SmallCensusPairs& row, float* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    const auto sum = static_cast<float>(distance(row, column, lane));
    return row.channels > 1 ? sum * (1.0F / 3.0F) : sum;
  });
}

void small_census_likelihood_row_ref(const SmallCensusPairs& row,
                                     const LikelihoodByDistance& likelihoods, float* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    return lane < row.count ? likelihoods.at(distance(row, column, lane)) : 0.0F;
  });
}

void small_census_energy_row_ref(const SmallCensusPairs& row, const EnergyByDistance& energies,
                                 std::uint8_t* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    return lane < row.count ? energies.steps[static_cast<std::size_t>(distance(row, column, lane))]
                            : std::numeric_limits<std::uint8_t>::max();
  });
}

}  // namespace vantage::kernels
