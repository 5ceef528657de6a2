#pragma once

#include <bit>
#include <cstdint>

namespace vantage::kernels {

// Exponential and logarithm of floats without fused multiply-add, so that every instruction set
// gives the same bits. exp_log-inl.h performs the same steps on vectors. Both polynomials are
// minimax fits for these functions, evaluated in independent parts.

/// 2^f = 1 + f · (…), f in [−½, ½]; relative error of the fit 9.2e-8.
inline constexpr float kExp2Polynomial[] = {0.693146978F, 0.240222421F, 0.0555073374F,
                                            0.00967151264F, 0.00132647272F};
/// log(1 + f) = f − f²/2 + f³ · (…), 1 + f in [√½, √2]; error of the fit 7e-9.
inline constexpr float kLogPolynomial[] = {0.333341659F, -0.250016987F, 0.199548758F, -0.165644256F,
                                           0.14977992F,  -0.143790087F, 0.0867219099F};

/// Exponents are clamped to at least this: 2^−125 is still a normal float.
inline constexpr float kMinExponent = -125.0F;
/// 1.5 · 2²³: adding it to a small number rounds that to an integer, which is then in the low bits.
inline constexpr float kRoundToInteger = 12582912.0F;
/// Bits of √½, the lower end of the significand range of logarithms.
inline constexpr std::int32_t kRootHalfBits = 0x3F3504F3;
inline constexpr float kLn2 = 0.693147181F;
inline constexpr float kLog2E = 1.44269504F;

/// 2^exponent for exponents ≤ 0; relative error below 3e-7, exactly 1 at 0.
inline float exp2_of_negative(float exponent) {
  exponent = exponent > kMinExponent ? exponent : kMinExponent;
  const float shifted = exponent + kRoundToInteger;
  const float f = exponent - (shifted - kRoundToInteger);
  const float f2 = f * f;
  const float low = kExp2Polynomial[1] * f + kExp2Polynomial[0];
  const float middle = kExp2Polynomial[2] + kExp2Polynomial[3] * f;
  const float sum = (low + middle * f2) + kExp2Polynomial[4] * (f2 * f2);
  const float power = sum * f + 1.0F;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(power) +
                              (std::bit_cast<std::uint32_t>(shifted) << 23U));
}

/// Natural logarithm of a positive normal float; error below 2e-7 · max(1, |result|).
inline float log_of_normal(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  const std::int32_t exponent = (bits - kRootHalfBits) >> 23;
  const float f = std::bit_cast<float>(bits - static_cast<std::int32_t>(
                                                  static_cast<std::uint32_t>(exponent) << 23U)) -
                  1.0F;
  const float square = f * f;
  const float low = kLogPolynomial[0] + kLogPolynomial[1] * f;
  const float middle = kLogPolynomial[2] + kLogPolynomial[3] * f;
  const float high = (kLogPolynomial[4] + kLogPolynomial[5] * f) + kLogPolynomial[6] * square;
  const float sum = (low + middle * square) + high * (square * square);
  const float tail = (sum * f) * square - 0.5F * square;
  return (tail + f) + static_cast<float>(exponent) * kLn2;
}

}  // namespace vantage::kernels
