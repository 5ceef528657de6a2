#pragma once

#include "engine/image/photograph.h"
#include "engine/io/video/libav.h"

namespace vantage {

/// Converts photographs to frames for encoders: BT.709 yuv420p with limited range, chroma sampled
/// at the left, as in H.264.
class PhotographToFrame {
 public:
  /// Size of the photographs. Frames have even sizes: an odd last column or row is repeated.
  PhotographToFrame(int width, int height);

  /// The frame, valid until the next convert(). 4-channel photographs lose their alpha.
  AVFrame& convert(const Photograph& photograph);

 private:
  int width_;
  int height_;
  LibavScaler scaler_;
  LibavFrame rgb_;
  LibavFrame yuv_;
};

}  // namespace vantage
