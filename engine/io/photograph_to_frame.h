#pragma once

#include "engine/image/photograph.h"
#include "engine/io/libav.h"

namespace vantage {

/// Makes frames for encoders of photographs: yuv420p of BT.709 with limited range, chroma sampled
/// at the left, as H.264 has it.
class PhotographToFrame {
 public:
  /// Size of the photographs. Frames have even sizes: an odd last column or row is repeated.
  PhotographToFrame(int width, int height);

  /// The frame, until convert() is called again. 4-channel photographs lose their alpha.
  AVFrame& convert(const Photograph& photograph);

 private:
  int width_;
  int height_;
  LibavScaler scaler_;
  LibavFrame rgb_;
  LibavFrame yuv_;
};

}  // namespace vantage
