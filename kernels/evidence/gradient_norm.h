#pragma once

#include <algorithm>
#include <cmath>

namespace vantage::kernels {

/// Length of a gradient or of the difference of two.
enum class EvidenceNorm {
  kL2,
  kOctagon,  ///< f1·L1 + f∞·L∞ (5.15–5.17), within 4 % of L2
  kL1,
  kMax,    ///< L∞
  kAcross  ///< |x|: the x component alone (5.8)
};

/// Weights of the octagonal norm.
inline constexpr float kOctagonSum = 0.3978247F;
inline constexpr float kOctagonMax = 0.5626091F;

/// The norms, one number at a time.
inline float gradient_norm(float x, float y, EvidenceNorm norm) {
  const float across = std::abs(x);
  const float down = std::abs(y);
  switch (norm) {
    case EvidenceNorm::kL2:
      return std::sqrt(x * x + y * y);
    case EvidenceNorm::kOctagon:
      return kOctagonSum * (across + down) + kOctagonMax * std::max(across, down);
    case EvidenceNorm::kL1:
      return across + down;
    case EvidenceNorm::kMax:
      return std::max(across, down);
    case EvidenceNorm::kAcross:
      break;
  }
  return across;
}

}  // namespace vantage::kernels
