#pragma once

#include <array>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/synthesis/unrectified_pair.h"
#include "kernels/nearest_lookup/nearest_lookup.h"

namespace vantage {

/// Brings the disparity maps of rectified images onto the pixels of the photographs, so that new
/// views can be made from an UnrectifiedPair. Which rectified pixel is nearest to each pixel of a
/// photograph is worked out once.
///
/// Thread rule: after construction everything may be called concurrently, for different results.
/// Identical for any execution.
class PhotographGrid {
 public:
  /// 4 bytes per pixel and image, and some 12 after a view from the image's camera has looked
  /// beyond the rectified image; rectified positions are interpolated between every eighth
  /// pixel where the lens allows it. `rectifier` needs rectification; it and `execution` outlive
  /// the grid.
  PhotographGrid(const Rectifier& rectifier, Execution& execution);

  /// Memory that it holds for images of this size, without whole photographs.
  static std::size_t held_bytes(int width, int height);

  /// `map`, a disparity map of the rectified image of that side, as seen by the photograph's
  /// pixels: each has the disparity of the rectified pixel nearest to it. Those beyond the outline
  /// of the rectified image take the nearest pixel of the outline, so that surfaces go on there;
  /// NaN where the lens model has no rectified position. `result` keeps its memory where that
  /// suffices. Throws Error if the map has another size than the rectifier's images.
  void bring(Side side, ImageView<const float> map, Image<float>& result) const;
  /// The same of both maps of a pair; `results` are the left and the right one's.
  void bring(const DisparityMaps& maps, std::array<Image<float>, 2>& results) const;

  /// What views are made from: photographs, and their maps from bring(), which outlive it, as the
  /// grid does.
  [[nodiscard]] UnrectifiedPair pair_of(const Photograph& left, const Photograph& right,
                                        const std::array<Image<float>, 2>& photograph_maps) const;

 private:
  /// Of all pixels of a photograph, row by row.
  [[nodiscard]] std::vector<kernels::PixelPlace> find_nearest_pixels(Side side) const;

  const Rectifier& rectifier_;
  Execution& execution_;
  // Left, right.
  std::array<std::vector<kernels::PixelPlace>, 2> nearest_;
  std::array<WholePhotograph, 2> whole_;
};

}  // namespace vantage
