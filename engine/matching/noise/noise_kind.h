#pragma once

namespace vantage {

/// What is wrong with the grey levels of the images of a call.
enum class NoiseKind {
  kNone,
  kSensor,  ///< noise that is independent in every pixel
  kCodec,   ///< values rounded by a lossy codec, in blocks
};

}  // namespace vantage
