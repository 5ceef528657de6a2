#pragma once

#include <functional>

#include "engine/image/photograph.h"
#include "engine/io/video/film_format.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_coding.h"

namespace vantage {

/// Converts a photograph to a frame. Thread rule: one thread at a time.
using FrameConversion = std::function<LibavFrame(const Photograph&)>;

/// For the encoder of `coding` and photographs of that size. An odd last column or row is repeated
/// unless the coding has odd sizes, and so is an only one. Colours get the matrix and the range of
/// written_colours() of `source`, by default BT.709 with limited range; chroma is sampled at the
/// left, without alpha. Grey codings take one channel of 16 bits, else they throw Error; of 10
/// bits, 0 stays 0 and 1..65535 become 1..1023, rounded.
FrameConversion make_frame_conversion(VideoCoding coding, int width, int height,
                                      const FilmColours& source = {});

}  // namespace vantage
