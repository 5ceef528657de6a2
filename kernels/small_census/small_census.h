#pragma once

#include <array>
#include <cstdint>

#include "kernels/census/census.h"

namespace vantage::kernels {

// Cells from the Hamming distances of small census codes: the distances themselves, or what a table
// says of each, which costs less than computing it. All identical on every instruction set.

/// Distances, 0..24. Of three channels: the mean. Writes columns × lanes floats.
void small_hamming_row(const SmallCensusPairs& row, float* cells);
void small_hamming_row_ref(const SmallCensusPairs& row, float* cells);

/// Entries of tables that are looked up by distance.
inline constexpr int kSmallCensusDistances = kSmallCensusBits + 1;

/// Floats by distance, in the form in which vectors look them up.
class LikelihoodByDistance {
 public:
  LikelihoodByDistance() = default;
  explicit LikelihoodByDistance(const std::array<float, kSmallCensusDistances>& likelihoods);

  /// distance: 0..24.
  [[nodiscard]] float at(int distance) const;
  /// Byte b, the least significant first, of all entries; zeros from the last one on.
  [[nodiscard]] const std::uint8_t* bytes(int b) const {
    return bytes_[static_cast<std::size_t>(b)].data();
  }

 private:
  static constexpr std::size_t kTableBytes = 32;
  alignas(16) std::array<std::array<std::uint8_t, kTableBytes>, sizeof(float)> bytes_{};
};

/// likelihoods.at(distance). One channel. Lanes from row.count on become 0.
void small_census_likelihood_row(const SmallCensusPairs& row,
                                 const LikelihoodByDistance& likelihoods, float* cells);
void small_census_likelihood_row_ref(const SmallCensusPairs& row,
                                     const LikelihoodByDistance& likelihoods, float* cells);

/// Bytes by distance; more of them than there are, as vectors load them.
struct EnergyByDistance {
  alignas(16) std::array<std::uint8_t, 32> steps{};
};

/// energies.steps[distance]. One channel. Lanes from row.count on become 255.
void small_census_energy_row(const SmallCensusPairs& row, const EnergyByDistance& energies,
                             std::uint8_t* cells);
void small_census_energy_row_ref(const SmallCensusPairs& row, const EnergyByDistance& energies,
                                 std::uint8_t* cells);

}  // namespace vantage::kernels
