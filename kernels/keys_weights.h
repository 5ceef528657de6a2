#pragma once

namespace vantage::kernels {

/// Weights of the pixels at −1, 0, 1 and 2 for a position in [0, 1).
struct KeysWeights {
  float at[4];
};

/// Keys' cubic convolution with a = −½ for a position f in [0, 1). keys_weights-inl.h performs the
/// same steps on vectors.
inline KeysWeights keys_weights(float f) {
  return {{f * (f * (1.0F - 0.5F * f) - 0.5F), f * f * (1.5F * f - 2.5F) + 1.0F,
           f * (f * (2.0F - 1.5F * f) + 0.5F), f * f * (0.5F * f - 0.5F)}};
}

}  // namespace vantage::kernels
