#pragma once

#include <cstddef>
#include <optional>

#include "engine/rectification/rectified_pair.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Properties of a run's pairs, from the first one.
struct PairShape {
  ImageExtent source;  ///< before rectification, which keeps the size
  int channels = 1;
  int bytes_per_value = 1;
  bool is_video = false;                      ///< they come from videos
  bool is_rectified_here = false;             ///< a calibration is applied
  int cameras_kept = 1;                       ///< whose rectifications are in memory
  int frames_kept = 0;                        ///< PairSource::frames_kept()
  int pair_count = 1;                         ///< of the input
  std::optional<RectifiedPair> cameras = {};  ///< if the pairs are calibrated

  [[nodiscard]] std::size_t pixels() const { return pixels_of(source); }
  /// Of one image, or of a picture of another size.
  [[nodiscard]] std::size_t photograph_bytes() const { return photograph_bytes(source); }
  [[nodiscard]] std::size_t photograph_bytes(ImageExtent extent) const {
    return pixels_of(extent) * static_cast<std::size_t>(channels) *
           static_cast<std::size_t>(bytes_per_value);
  }
  static std::size_t pixels_of(ImageExtent extent) {
    return static_cast<std::size_t>(extent.width_px) * static_cast<std::size_t>(extent.height_px);
  }
};

}  // namespace vantage
