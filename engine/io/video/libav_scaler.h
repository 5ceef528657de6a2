#pragma once

#include <vector>

#include "engine/io/video/libav.h"

struct AVPixFmtDescriptor;

namespace vantage {

/// Position of chroma samples relative to their first luma pixel, in 1/256 luma pixel.
struct ChromaPosition {
  int x = 0;
  int y = 0;
};

/// Position for one of FFmpeg's location constants, in frames of that format.
ChromaPosition chroma_position(int location, const AVPixFmtDescriptor& format);

/// Throws Error for a number that is no pixel format.
const AVPixFmtDescriptor& describe_pixel_format(int format);

/// Converts between pixel formats. Formats and matrix are FFmpeg's numbers (AV_PIX_FMT_…,
/// SWS_CS_…).
struct ScalerOptions {
  int width = 0;
  int height = 0;
  int source_format = 0;
  int target_format = 0;
  bool source_full_range = true;
  bool target_full_range = true;
  int matrix = 1;  ///< BT.709
  ChromaPosition source_chroma = {};
  ChromaPosition target_chroma = {};
};

/// Interpolates chroma bicubically, for every pixel, with rounding; bit-identical on every machine.
/// Throws Error, without a name, for a format that cannot be converted.
LibavScaler make_scaler(const ScalerOptions& options);

/// A frame with allocated pixels. Throws std::bad_alloc.
LibavFrame make_picture(int width, int height, int format);

/// Frames of one kind, whose memory is used again when the last reference to it is gone. Thread
/// rule: one thread at a time.
class PicturePool {
 public:
  PicturePool(int width, int height, int format);
  /// Throws std::bad_alloc.
  LibavFrame make();

 private:
  int width_;
  int height_;
  int format_;
  std::vector<LibavFrame> frames_;
};

}  // namespace vantage
