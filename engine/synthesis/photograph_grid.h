#pragma once

#include <Eigen/Core>
#include <array>
#include <mutex>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/synthesis/unrectified_pair.h"
#include "kernels/nearest_lookup/nearest_lookup.h"

namespace vantage {

/// The rectified image extended to the whole photograph. A rectified image covers only the part
/// that the other camera sees too; views from the camera's own position show the photograph
/// everywhere and need no disparities. Made by the first call of window().
///
/// Thread rule: may be used concurrently.
class WholePhotograph {
 public:
  /// Valid as long as the WholePhotograph. Both images have the same size, at most three times that
  /// of the rectified image in either direction.
  struct Window {
    Eigen::Vector2d first_px;       ///< rectified position of its first pixel, ≤ 0
    PhotographPositions positions;  ///< of its pixels
    /// 0 where the photograph covers the whole pixel (disparity of points at infinity), else NaN.
    ImageView<const float> disparity_px;
    /// Disparities of the photograph's pixels: 0.
    ImageView<const float> photograph_disparity_px;
  };

  /// `rectifier` must need rectification; it and `execution` outlive the WholePhotograph.
  WholePhotograph(const Rectifier& rectifier, Side side, Execution& execution);

  [[nodiscard]] const Window& window() const;

 private:
  void make_window() const;

  const Rectifier& rectifier_;
  Side side_;
  Execution& execution_;
  mutable std::once_flag is_made_;
  mutable Image<float> x_px_;
  mutable Image<float> y_px_;
  mutable Image<float> disparity_px_;
  mutable Image<float> zeros_;  // one row
  mutable Window window_;
};

/// Resamples the disparity maps of rectified images to the pixels of the photographs, so that new
/// views can be made from an UnrectifiedPair. The rectified pixel nearest to each photograph pixel
/// is computed once.
///
/// Thread rule: after construction everything may be called concurrently, for different results.
/// Identical for any execution.
class PhotographGrid {
 public:
  /// 4 bytes per pixel and image, and about 12 more once a view from the image's camera extends
  /// beyond the rectified image; rectified positions are interpolated between every eighth pixel
  /// where the lens allows it. `rectifier` must need rectification; it and `execution` outlive the
  /// grid.
  PhotographGrid(const Rectifier& rectifier, Execution& execution);

  /// Bytes held for images of this size, without whole photographs.
  static std::size_t held_bytes(int width, int height);

  /// Resamples `map`, a disparity map of the rectified image of that side, to the photograph's
  /// pixels: each gets the disparity of the nearest rectified pixel. Pixels beyond the outline of
  /// the rectified image get the nearest pixel of the outline, which extends the surfaces; NaN
  /// where the lens model has no rectified position. Reuses the memory of `result`. Throws Error if
  /// the map's size is not that of the rectifier's images.
  void bring(Side side, ImageView<const float> map, Image<float>& result) const;
  /// bring() for both maps of a pair; `results`: left, right.
  void bring(const DisparityMaps& maps, std::array<Image<float>, 2>& results) const;

  /// Input of view synthesis: photographs, and their maps from bring(), which must outlive it, as
  /// must the grid.
  [[nodiscard]] UnrectifiedPair pair_of(const Photograph& left, const Photograph& right,
                                        const std::array<Image<float>, 2>& photograph_maps) const;

 private:
  /// For all pixels of a photograph, row by row.
  [[nodiscard]] std::vector<kernels::PixelPlace> find_nearest_pixels(Side side) const;

  const Rectifier& rectifier_;
  Execution& execution_;
  // Left, right.
  std::array<std::vector<kernels::PixelPlace>, 2> nearest_;
  std::array<WholePhotograph, 2> whole_;
};

}  // namespace vantage
