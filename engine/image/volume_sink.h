#pragma once

#include <optional>

#include "engine/image/disparity_range.h"

namespace vantage {

/// What the values of a volume are.
enum class VolumeContent {
  kEnergies,       ///< small: likely. Costs, mean costs, −log p
  kProbabilities,  ///< they sum to 1 over the candidates that were searched
};

/// A volume of the disparity space: one value for each candidate of each pixel.
struct VolumeShape {
  int width_px = 0;  ///< of the level
  int height_px = 0;
  DisparityRange disparities = {};  ///< in pixels of the full-size image on every level
  int steps_per_px = 1;             ///< candidates per pixel of disparity
  /// Of a two-dimensional search: candidates are all pairs, horizontal disparities innermost.
  std::optional<DisparityRange> disparities_y = {};
  VolumeContent content = VolumeContent::kEnergies;

  /// Horizontal candidates.
  [[nodiscard]] int row_candidates() const {
    return steps_per_px * (disparities.max - disparities.min) + 1;
  }
  /// Values per pixel.
  [[nodiscard]] int candidates() const {
    return row_candidates() * (disparities_y ? disparities_y->count() : 1);
  }
  /// Of a horizontal candidate.
  [[nodiscard]] double disparity_px(int candidate) const {
    return disparities.min + static_cast<double>(candidate) / steps_per_px;
  }
};

/// Takes a volume in parts as they are computed, so that it never needs to be in memory.
class VolumeSink {
 public:
  VolumeSink() = default;
  VolumeSink(const VolumeSink&) = delete;
  VolumeSink& operator=(const VolumeSink&) = delete;
  virtual ~VolumeSink() = default;

  /// Called once, before any values.
  virtual void start(const VolumeShape& shape) = 0;
  /// Columns [x, x + columns) of row y, the candidates of a column contiguous; NaN where a
  /// candidate has no partner or was not searched. Each pixel once, in any order, from several
  /// threads at a time.
  virtual void write(int x, int y, int columns, const float* values) = 0;
};

}  // namespace vantage
