#include <bit>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "kernels/ray_census/ray_census.h"

namespace vantage::kernels {
namespace {

/// Distance summed over all channels.
int distance(const RayCensusPairs& row, int column, int lane) {
  int different = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [reference, partner] = row.channel[static_cast<std::size_t>(c)];
    const int at = column * row.partner_step + lane;
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      for (unsigned bit = 0; bit < 8; ++bit) {
        // The neighbour's number in a code.
        const auto number = [&](const auto& planes, int k) {
          const int upper = (planes[p][k] >> bit) & 1;
          return row.thresholds == 1 ? upper
                                     : 2 * upper + ((planes[p + kRayCensusBytes][k] >> bit) & 1);
        };
        different += std::abs(number(reference, column) - number(partner, at));
      }
    }
  }
  return different;
}

/// Writes cell(column, lane) to all cells.
template <typename Value, typename Cell>
void each_cell(const RayCensusPairs& row, Value* cells, const Cell& cell) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      cells[j * row.lanes + i] = cell(j, i);
    }
  }
}

}  // namespace

LikelihoodByDistance::LikelihoodByDistance(
    const std::array<float, kMaxRayCensusDistances>& likelihoods) {
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

void ray_hamming_row_ref(const RayCensusPairs& row, float* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    const auto sum = static_cast<float>(distance(row, column, lane));
    const int codes = row.channels * row.thresholds;
    return codes > 1 ? sum * (1.0F / static_cast<float>(codes)) : sum;
  });
}

void ray_census_likelihood_row_ref(const RayCensusPairs& row,
                                   const LikelihoodByDistance& likelihoods, float* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    return lane < row.count ? likelihoods.at(distance(row, column, lane)) : 0.0F;
  });
}

void ray_census_energy_row_ref(const RayCensusPairs& row, const ByteByDistance& energies,
                               std::uint8_t* cells) {
  each_cell(row, cells, [&](int column, int lane) {
    return lane < row.count ? energies.steps[static_cast<std::size_t>(distance(row, column, lane))]
                            : std::numeric_limits<std::uint8_t>::max();
  });
}

}  // namespace vantage::kernels
