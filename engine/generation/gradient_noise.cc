#include "engine/generation/gradient_noise.h"

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

}  // namespace vantage
