#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/video/libav.h"
#include "kernels/rgb_row/rgb_row.h"

namespace vantage {

/// Converts decoded frames to photographs: RGB for colours, one channel for grey; 8-bit, or 16-bit
/// if the frame has more bits. Chroma is interpolated bicubically from its sample positions. Matrix
/// and range are those flagged in the frame; if unspecified, colours are BT.601 below 720 rows,
/// else BT.709, with limited range, and grey levels have full range, as in players.
class FrameToPhotograph {
 public:
  /// Reuses the memory of `photograph`. Throws Error, without a name, for a format that cannot be
  /// converted.
  void convert(const AVFrame& frame, Photograph& photograph);

 private:
  /// Prepares convert() for frames like this one.
  void prepare(const AVFrame& frame);
  template <typename T>
  void fill(const AVFrame& frame, Image<T>& image);

  /// Frame properties that the following members were made for.
  struct Source {
    int width = 0;
    int height = 0;
    int format = -1;
    int colour_space = 0;
    int colour_range = 0;
    int chroma_location = 0;
    bool operator==(const Source&) const = default;
  };
  Source source_;
  bool grey_ = false;
  bool wide_ = false;                  ///< more than 8 bits
  std::vector<std::uint16_t> levels_;  ///< value of each grey sample; empty: not grey
  LibavScaler scaler_;
  LibavFrame yuv_;  ///< 16-bit luma and chroma of every pixel; empty: the scaler makes the result
  kernels::ColourFactors factors_;
};

}  // namespace vantage
