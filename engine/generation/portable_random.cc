#include "engine/generation/portable_random.h"

#include <cmath>

namespace vantage {
namespace {

// ln(x) for x > 0 by log x = e ln 2 + 2 artanh((m - 1)/(m + 1)). std::log may differ in the last
// place between platforms; additions, products and quotients do not.
double portable_log(double x) {
  constexpr double kLn2 = 0.693147180559945309417;
  constexpr double kSqrtHalf = 0.707106781186547524401;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < kSqrtHalf) {
    mantissa *= 2;
    --exponent;
  }
  const double ratio = (mantissa - 1) / (mantissa + 1);
  const double square = ratio * ratio;
  double sum = 0;
  for (int power = 21; power >= 1; power -= 2) {
    sum = sum * square + 1.0 / power;
  }
  return exponent * kLn2 + 2 * ratio * sum;
}

}  // namespace

PortableRandom::PortableRandom(std::uint64_t seed, std::uint64_t stream)
    : engine_(mix_bits(mix_bits(seed) + stream)) {}

double PortableRandom::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

// Marsaglia's polar method: two normal numbers from a point inside the unit circle.
double PortableRandom::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  double u = 0;
  double v = 0;
  double square = 0;
  do {
    u = 2 * uniform() - 1;
    v = 2 * uniform() - 1;
    square = u * u + v * v;
  } while (square >= 1 || square == 0);
  const double factor = std::sqrt(-2 * portable_log(square) / square);
  spare_normal_ = v * factor;
  has_spare_ = true;
  return u * factor;
}

}  // namespace vantage
