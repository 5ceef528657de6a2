#pragma once

#include <array>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/census/census.h"

namespace vantage::kernels {

// Cells from the Hamming distances of ray census codes: the distances themselves, or what a table
// says of each, which costs less than computing it. All identical on every instruction set.

/// Neighbours that differ, 0..24: bits ÷ thresholds. Of three channels: the mean. Writes columns ×
/// lanes floats.
void ray_hamming_row(const RayCensusPairs& row, float* cells);
void ray_hamming_row_ref(const RayCensusPairs& row, float* cells);

/// Entries of tables that are looked up by the number of bits that differ, at most 24 a threshold.
constexpr int ray_census_distances(int thresholds) { return kRayCensusNeighbours * thresholds + 1; }
inline constexpr int kMostRayCensusDistances = ray_census_distances(kMostRayCensusThresholds);
/// Tables are looked up in parts of 16 entries.
inline constexpr int kRayCensusTableBytes =
    (kMostRayCensusDistances + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;

/// Floats by distance, in the form in which vectors look them up.
class LikelihoodByDistance {
 public:
  LikelihoodByDistance() = default;
  explicit LikelihoodByDistance(const std::array<float, kMostRayCensusDistances>& likelihoods);

  /// distance: 0..72.
  [[nodiscard]] float at(int distance) const;
  /// Byte b, the least significant first, of all entries; zeros from the last one on.
  [[nodiscard]] const std::uint8_t* bytes(int b) const {
    return bytes_[static_cast<std::size_t>(b)].data();
  }

 private:
  alignas(16) std::array<std::array<std::uint8_t, kRayCensusTableBytes>, sizeof(float)> bytes_{};
};

/// likelihoods.at(distance). One channel. Lanes from row.count on become 0.
void ray_census_likelihood_row(const RayCensusPairs& row, const LikelihoodByDistance& likelihoods,
                               float* cells);
void ray_census_likelihood_row_ref(const RayCensusPairs& row,
                                   const LikelihoodByDistance& likelihoods, float* cells);

/// Bytes by distance; more of them than there are, as vectors load them.
struct EnergyByDistance {
  alignas(16) std::array<std::uint8_t, kRayCensusTableBytes> steps{};
};

/// energies.steps[distance]. One channel. Lanes from row.count on become 255.
void ray_census_energy_row(const RayCensusPairs& row, const EnergyByDistance& energies,
                           std::uint8_t* cells);
void ray_census_energy_row_ref(const RayCensusPairs& row, const EnergyByDistance& energies,
                               std::uint8_t* cells);

}  // namespace vantage::kernels
