#pragma once

#include <array>
#include <cstdint>

namespace vantage {

/// Smooth 3D noise with a random gradient at each integer lattice point (Perlin), with a period of
/// 256 units. Mean 0, within about ±1, hardly any power above one cycle per unit. Thread rule:
/// immutable.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed);

  /// |x|, |y|, |z| < 2³⁰.
  [[nodiscard]] double at(double x, double y, double z) const;

 private:
  std::array<std::uint8_t, 512> permutation_{};  // of 0..255, repeated
};

}  // namespace vantage
