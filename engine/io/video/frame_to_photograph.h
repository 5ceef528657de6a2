#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/video/chroma_upsampler.h"
#include "engine/io/video/libav.h"
#include "kernels/rgb_row/rgb_row.h"

namespace vantage {

/// The left and the right half of a picture; null: not wanted.
using PictureHalves = std::array<Photograph*, 2>;

/// Converts decoded frames to photographs: RGB for colours, one channel for grey; 8-bit, or 16-bit
/// if the frame has more bits. Chroma is interpolated bicubically from its sample positions. Matrix
/// and range are those flagged in the frame; if unspecified, colours are BT.601 below 720 rows,
/// else BT.709, with limited range, and grey levels have full range, as in players.
class FrameToPhotograph {
 public:
  /// Reuses the memory of `photograph`. Throws Error, without a name, for a format that cannot be
  /// converted.
  void convert(const AVFrame& frame, Photograph& photograph);

  /// Converts the left and the right half of the frame into one photograph each. Returns false, and
  /// changes nothing, for grey and RGB formats and for odd widths.
  bool convert_halves(const AVFrame& frame, const PictureHalves& halves);

 private:
  /// Prepares convert() for frames like this one.
  void prepare(const AVFrame& frame);
  template <typename T>
  void fill(const AVFrame& frame, Image<T>& image);
  /// By the scaler.
  void scale(const AVFrame& frame, std::uint8_t* const* planes, const int* pitches);
  /// Converts luma and chroma. The columns of the frame are divided equally among `parts`.
  template <typename T>
  void fill_colours(const AVFrame& frame, std::span<Photograph* const> parts);
  /// The next row, from above, of luma and chroma of every pixel.
  kernels::LumaChromaRow next_row(int y);

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
  bool wide_ = false;  ///< more than 8 bits
  bool has_chroma_ = false;
  std::vector<std::uint16_t> levels_;  ///< value of each grey sample; empty: not grey
  LibavScaler scaler_;
  LibavFrame
      yuv_;  ///< what the scaler makes of chroma; empty: it makes the result, or is not there
  ChromaUpsampler upsampler_;
  kernels::ColourFactors factors_;
};

}  // namespace vantage
