#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/census/census.h"

namespace vantage::kernels {

// Cells from the Hamming distances of ray census codes: the distances themselves, or table entries
// looked up by distance, which is cheaper than computing them. All functions are identical on every
// instruction set.

/// Number of differing neighbours, 0..24: bits ÷ thresholds. With three channels: the mean. Writes
/// columns × lanes floats.
void ray_hamming_row(const RayCensusPairs& row, float* cells);

/// Number of table entries, indexed by the number of differing bits (at most 24 per threshold).
constexpr int ray_census_distances(int thresholds) { return kRayCensusNeighbours * thresholds + 1; }
inline constexpr int kMaxRayCensusDistances = ray_census_distances(kMaxRayCensusThresholds);
/// Tables are looked up in parts of 16 entries.
inline constexpr int kRayCensusTableBytes =
    (kMaxRayCensusDistances + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;

/// Floats indexed by distance, in the layout of the vector lookup.
class LikelihoodByDistance {
 public:
  LikelihoodByDistance() = default;
  explicit LikelihoodByDistance(const std::array<float, kMaxRayCensusDistances>& likelihoods);

  /// distance: 0..72.
  [[nodiscard]] float at(int distance) const;
  /// Byte b (0 = least significant) of all entries; zeros after the last one.
  [[nodiscard]] const std::uint8_t* bytes(int b) const {
    return bytes_[static_cast<std::size_t>(b)].data();
  }

 private:
  alignas(16) std::array<std::array<std::uint8_t, kRayCensusTableBytes>, sizeof(float)> bytes_{};
};

/// likelihoods.at(distance). One channel. Lanes ≥ row.count become 0.
void ray_census_likelihood_row(const RayCensusPairs& row, const LikelihoodByDistance& likelihoods,
                               float* cells);

/// Bytes indexed by distance, padded to whole vectors.
struct ByteByDistance {
  alignas(64) std::array<std::uint8_t, kRayCensusTableBytes> steps{};
  /// The last entry that differs from the one before: all after it are equal to it, and need not be
  /// looked up.
  int last = kMaxRayCensusDistances - 1;

  /// Finds `last` of a table whose first `distances` entries are used.
  void find_last(int distances) {
    last = distances - 1;
    while (last > 0 &&
           steps[static_cast<std::size_t>(last)] == steps[static_cast<std::size_t>(last) - 1]) {
      --last;
    }
  }
};

/// energies.steps[distance]. One channel. Lanes ≥ row.count become 255.
void ray_census_energy_row(const RayCensusPairs& row, const ByteByDistance& energies,
                           std::uint8_t* cells);

}  // namespace vantage::kernels
