#pragma once

#include <cstdint>

#include "engine/image/photograph.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_coding.h"

namespace vantage {

/// The 10-bit code of a 16-bit one: 0 stays 0, 1..65535 become 1..1023, rounded.
constexpr std::uint16_t ten_bits(std::uint16_t value) {
  return static_cast<std::uint16_t>(value == 0 ? 0 : 1 + ((value - 1) * 1022U + 32767) / 65534);
}

/// Converts one-channel photographs of 16 bits to frames for encoders of grey videos.
class GreyToFrame {
 public:
  /// Size of the photographs; frames have even sizes unless the coding allows odd ones: an odd last
  /// column or row is repeated.
  GreyToFrame(VideoCoding coding, int width, int height);

  /// The frame, valid until the next convert(). Throws Error unless the photograph is grey of 16
  /// bits.
  AVFrame& convert(const Photograph& photograph);

 private:
  VideoCoding coding_;
  LibavFrame frame_;
};

/// FFmpeg's pixel format of a grey coding.
int pixel_format_of(VideoCoding coding);
/// Whether encoders of this coding take odd sizes.
constexpr bool takes_odd_sizes(VideoCoding coding) {
  return coding == VideoCoding::kFfv1_16 || coding == VideoCoding::kFfv1_10;
}

}  // namespace vantage
