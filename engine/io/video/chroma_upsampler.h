#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/video/libav.h"
#include "kernels/rgb_row/rgb_row.h"

namespace vantage {

/// Luma and chroma of every pixel, row by row, for the usual film: 8-bit 4:2:0 in planes, chroma
/// beside every second column, even sides from 14 on. Bit for bit what make_scaler() makes of it in
/// the format YUV444P16, without a picture of 16 bits in between.
class ChromaUpsampler {
 public:
  static bool serves(const AVFrame& frame);

  /// For the rows of `frame`, which must outlive the calls of next_row().
  void begin(const AVFrame& frame);
  /// The rows from the uppermost on, valid until the next call.
  kernels::LumaChromaRow next_row();

 private:
  const AVFrame* frame_ = nullptr;
  int next_row_ = 0;
  int rows_made_ = 0;                  ///< of chroma, its columns interpolated
  std::vector<std::int32_t> columns_;  ///< the last four of them, of both planes
  std::vector<std::uint16_t> row_;     ///< of the three planes
};

}  // namespace vantage
