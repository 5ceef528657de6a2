#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "engine/generation/scene_surface.h"

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

/// Colours of one surface, RGB in grey levels 0..255: noise mixes a with b, and c with d where the
/// surface's pattern is 1.
struct Palette {
  Eigen::Vector3d a, b, c, d;
};

/// Colours of surface points: matte surfaces under one fixed light, with noise of wavelengths from
/// 5 to 100 pixels so that every neighbourhood can be matched. Thread rule: immutable.
class SceneTexture {
 public:
  explicit SceneTexture(std::uint64_t seed) : noise_(seed) {}

  /// RGB in grey levels, not clipped. Independent of the viewpoint.
  [[nodiscard]] Eigen::Vector3d colour(const Palette& palette, const SurfaceDetail& detail) const;

 private:
  GradientNoise noise_;
};

}  // namespace vantage
