#pragma once

#include <array>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Two posed cameras rectified on their own, in any direction from each other. Their maps are
/// brought back to the pinhole cameras of the photographs: K and size of a photograph, without its
/// distortion.
///
/// Thread rule: everything may be called concurrently.
class PosedPair {
 public:
  /// Throws Error as rectified_pair() does. `execution` must outlive the pair.
  PosedPair(const StereoCalibration& calibration, int width_px, int height_px,
            Execution& execution);

  /// The photographs with corresponding rows.
  [[nodiscard]] std::array<Photograph, 2> rectified(
      const std::array<Photograph, 2>& photographs) const;

  /// Pixels of disparity between the rectified images per unit of nearness, the baseline divided by
  /// the depth in them: their focal length.
  [[nodiscard]] double focal_length_px() const { return rectifier_.pair().left.matrix(0, 0); }

  /// A map of the rectified images on the grid of the photograph's pinhole camera, as `scale_px` ·
  /// baseline / depth in that camera. Disparities are interpolated among pixels that differ by at
  /// most a pixel, else taken from the nearest; negative ones count as infinity. Pixels that the
  /// rectified image does not show are NaN and unmatched.
  [[nodiscard]] MatchedMap on_photograph(Side side, const MatchedMap& map, double scale_px) const;

 private:
  StereoCalibration calibration_;
  int width_px_;
  int height_px_;
  Rectifier rectifier_;
  Execution* execution_;
};

}  // namespace vantage
