#pragma once

#include <cstddef>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/soft_outlines.h"
#include "engine/synthesis/surface_colours.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/unrectified_pair.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/source_position/source_position.h"

namespace vantage {

/// The picture plane that images are brought to.
struct ViewFrame {
  int width_px = 0;
  int height_px = 0;
  double infinity_disparity_px = 0;  ///< see NewView
};

/// Brings one photograph to any new view in one pass (3.2.7): its disparities are mapped forward
/// into the view, and colours are fetched backward from it with one bicubic interpolation, however
/// many homographies lie between; with WarpColour::kForward, from the nearest pixel.
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class ImageWarper {
 public:
  /// Maps the disparities, in parallel. `disparity_px` is of the image's size. Where the image is
  /// the photograph that the map's image was made from, `photograph` says so. Throws Error for a
  /// view without pixels, with a side above 65500, or a warp that cannot be inverted.
  ImageWarper(ImageView<const T> image, ImageView<const float> disparity_px, const ViewWarp& warp,
              const ViewFrame& frame, const SynthesisOptions& options, Execution& execution,
              const PhotographGeometry& photograph = {});

  /// Memory that it holds for a view.
  static std::size_t held_bytes(int view_width, int view_height);

  [[nodiscard]] int width() const { return nearness_.width(); }
  [[nodiscard]] int height() const { return nearness_.height(); }
  [[nodiscard]] int channels() const { return colours_.pixels.channels(); }

  /// What a call of warp() works in; it holds nothing afterwards.
  [[nodiscard]] std::size_t scratch_floats() const;

  /// Row y of the new view: pixel_lanes(channels) values per pixel, 0 at holes, and nearness, NaN
  /// at holes.
  void warp(int y, std::span<float> scratch, float* colours, float* nearness) const;

  /// What this image knows of a surface's outline (kernels::surface_coverage()); NaN where it does
  /// not show the surface.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  void move_to_whole_pixels(const kernels::SourcePositions& positions) const;

  SurfaceColours<T> colours_;
  bool takes_whole_pixels_;
  kernels::SourceProjection back_;
  scheduler::ScratchPool::Lease nearness_memory_;
  ImageView<float> nearness_;  // −inf where nothing lands
};

}  // namespace vantage
