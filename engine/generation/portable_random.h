#pragma once

#include <cstdint>
#include <random>

namespace vantage {

/// Random numbers that are identical on every platform, unlike the distributions of the standard
/// library: a standard engine, and transforms that use exactly rounded operations only. Thread
/// rule: one thread per object.
class PortableRandom {
 public:
  /// Streams of one seed are independent.
  explicit PortableRandom(std::uint64_t seed, std::uint64_t stream = 0);

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform();
  /// Normal with mean 0 and standard deviation 1.
  [[nodiscard]] double normal();

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0;
  bool has_spare_ = false;
};

/// A bit mixer for seeds and for hashes of lattice points.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31);
}

}  // namespace vantage
