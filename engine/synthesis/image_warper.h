#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/soft_outlines.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/unrectified_pair.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/source_position/source_position.h"

namespace vantage {

/// Source of a new view's colours: an image, or the photograph that it was made from. Thread rule:
/// may be used concurrently. Nothing is owned. T is uint8_t, uint16_t or float.
template <typename T>
struct SurfaceColours {
  ImageView<const T> pixels;            ///< of the photograph, if there is one
  ImageView<const float> disparity_px;  ///< of the image
  PhotographGeometry photograph = {};   ///< empty: the pixels are the image's
  float gradient_limit_px = 1;

  /// One bicubic interpolation at each of `count` positions in the image (fetch_surface_row()),
  /// pixel_lanes(channels) values each. With a photograph, `positions` are converted to positions
  /// in it; positions outside it give 0.
  void fetch(const kernels::SourcePositions& positions, int count, float* colours) const;
};

/// Image plane that images are warped to.
struct ViewFrame {
  int width_px = 0;
  int height_px = 0;
  double infinity_disparity_px = 0;  ///< see NewView
};

/// Warps one photograph to any new view in one pass (3.2.7): its disparities are mapped forward
/// into the view, and colours are fetched backward with one bicubic interpolation, however many
/// homographies are composed; with WarpColour::kForward, from the nearest pixel.
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class ImageWarper {
 public:
  /// Maps the disparities, in parallel. `disparity_px` has the image's size. `photograph`: set if
  /// the image is the photograph that the map's image was rectified from. Throws Error for a view
  /// without pixels or with a side above 65500, or a warp that cannot be inverted.
  ImageWarper(ImageView<const T> image, ImageView<const float> disparity_px, const ViewWarp& warp,
              const ViewFrame& frame, const SynthesisOptions& options, Execution& execution,
              const PhotographGeometry& photograph = {});

  /// Bytes held for a view.
  static std::size_t held_bytes(int view_width, int view_height);

  [[nodiscard]] int width() const { return nearness_.width(); }
  [[nodiscard]] int height() const { return nearness_.height(); }
  [[nodiscard]] int channels() const { return colours_.pixels.channels(); }

  /// Scratch memory of one call of warp(), in floats; not kept between calls.
  [[nodiscard]] std::size_t scratch_floats() const;

  /// Row y of the new view: pixel_lanes(channels) values per pixel, 0 at holes, and nearness, NaN
  /// at holes.
  void warp(int y, std::span<float> scratch, float* colours, float* nearness) const;

  /// Coverage of a surface's outline in this image (kernels::surface_coverage()); NaN if the image
  /// does not show the surface.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  void move_to_whole_pixels(const kernels::SourcePositions& positions) const;

  SurfaceColours<T> colours_;
  bool takes_whole_pixels_;
  kernels::SourceProjection back_;
  scheduler::ScratchPool::Lease nearness_memory_;
  ImageView<float> nearness_;  // −inf where nothing was mapped
};

}  // namespace vantage
