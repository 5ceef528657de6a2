#pragma once

#include <cstddef>

namespace vantage {

/// What is wrong with the grey levels of the images of a call.
enum class NoiseKind {
  kNone,
  kSensor,  ///< noise that is independent in every pixel
  kCodec,   ///< values rounded by a lossy codec, in blocks
};
inline constexpr std::size_t kNoiseKinds = 3;

}  // namespace vantage
