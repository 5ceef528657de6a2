#include "engine/generation/scene_texture.h"

#include <algorithm>

namespace vantage {
namespace {

using Eigen::Vector3d;

// Wavelengths, in texture units, and strengths, in grey levels, of the noise added to the colours.
constexpr double kFineWavelength = 5;
constexpr double kMediumWavelength = 11;
constexpr double kCoarseWavelength = 24;
constexpr double kFineLevels = 46;
constexpr double kMediumLevels = 50;
constexpr double kCoarseLevels = 44;
// Wavelengths of the noise that mixes the two colours of a set.
constexpr double kMixWavelength = 48;
constexpr double kWideMixWavelength = 104;
// How much the fine noise tends to yellow and the medium noise to blue.
constexpr double kTint = 0.22;

constexpr double kAmbientLight = 0.5;

}  // namespace

Vector3d SceneTexture::colour(const Palette& palette, const SurfaceDetail& detail) const {
  // Light comes from above, left of and behind the cameras.
  const Vector3d to_light = Vector3d(-0.45, -0.7, -0.55).normalized();
  const double lambert = std::max(0.0, detail.normal.dot(to_light));
  const double lit = detail.light * (kAmbientLight + (1 - kAmbientLight) * lambert * 1.35);
  if (detail.is_uniform) {
    return palette.a * lit;
  }

  // The shift keeps a texture plane at 0 away from lattice points, where all noise is 0.
  const auto noise = [&](double wavelength, double shift) {
    const Vector3d q = detail.texture / wavelength;
    return noise_.at(q.x() + shift, q.y() + 2.3 * shift, q.z() + shift);
  };
  const double mix = std::clamp(
      0.5 + 0.9 * noise(kMixWavelength, 0.37) + 0.9 * noise(kWideMixWavelength, 17.61), 0.0, 1.0);
  const Vector3d base = palette.a + mix * (palette.b - palette.a);
  const Vector3d other = palette.c + mix * (palette.d - palette.c);
  Vector3d colour = base + detail.pattern * (other - base);

  const double fine = kFineLevels * noise(kFineWavelength, 5.43);
  const double medium = kMediumLevels * noise(kMediumWavelength, 9.29);
  const double coarse = kCoarseLevels * noise(kCoarseWavelength, 13.57);
  colour += Vector3d::Constant(fine + medium + coarse);
  colour += kTint * Vector3d(fine - medium, 0, medium - fine);
  return colour * lit;
}

}  // namespace vantage
