#include "engine/generation/scene_texture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/generation/portable_random.h"

namespace vantage {
namespace {

// Dot product of (x, y, z) with one of the twelve directions to the edges of a cube.
double along_gradient(unsigned hash, double x, double y, double z) {
  static constexpr double kGradients[16][3] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},
                                               {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                                               {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1},
                                               {1, 1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, -1}};
  const auto& gradient = kGradients[hash & 15];
  return gradient[0] * x + gradient[1] * y + gradient[2] * z;
}

// Weight of the upper neighbour, with two continuous derivatives.
double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double blend(double a, double b, double weight_of_b) { return a + weight_of_b * (b - a); }

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

GradientNoise::GradientNoise(std::uint64_t seed) {
  std::iota(permutation_.begin(), permutation_.begin() + 256, std::uint8_t{0});
  PortableRandom random(seed);
  for (int last = 255; last > 0; --last) {
    std::swap(permutation_[last], permutation_[static_cast<int>(random.uniform() * (last + 1))]);
  }
  std::copy_n(permutation_.begin(), 256, permutation_.begin() + 256);
}

double GradientNoise::at(double x, double y, double z) const {
  const double x_floor = std::floor(x);
  const double y_floor = std::floor(y);
  const double z_floor = std::floor(z);
  const unsigned xi = static_cast<unsigned>(static_cast<int>(x_floor)) & 255;
  const unsigned yi = static_cast<unsigned>(static_cast<int>(y_floor)) & 255;
  const unsigned zi = static_cast<unsigned>(static_cast<int>(z_floor)) & 255;
  const double fx = x - x_floor;
  const double fy = y - y_floor;
  const double fz = z - z_floor;

  // Corner sums over the two planes z and z + 1, interpolated along x, then y, then z.
  const auto plane = [&](unsigned dz) {
    const auto row = [&](unsigned dy) {
      const auto corner = [&](unsigned dx) {
        const unsigned hash = permutation_[permutation_[permutation_[xi + dx] + yi + dy] + zi + dz];
        return along_gradient(hash, fx - dx, fy - dy, fz - dz);
      };
      return blend(corner(0), corner(1), fade(fx));
    };
    return blend(row(0), row(1), fade(fy));
  };
  return blend(plane(0), plane(1), fade(fz));
}

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
