#include "engine/synthesis/surface_warper.h"

#include <cstdint>
#include <limits>

#include "engine/synthesis/surface_map.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/surface_coverage/surface_coverage.h"

namespace vantage {
namespace {

ViewFrame frame_of(const NewView& view) {
  return {.width_px = view.width_px,
          .height_px = view.height_px,
          .infinity_disparity_px = view.infinity_disparity_px};
}

// Options for an image whose camera is `distance` baselines away. At its own position nothing
// moves: there is no parallax to tear surfaces, and the whole image is one surface.
SynthesisOptions options_at(double distance, SynthesisOptions options) {
  if (distance < kSamePlace) {
    options.disparity_gradient_limit_px = std::numeric_limits<double>::infinity();
  }
  return options;
}

}  // namespace

template <typename T>
std::size_t SurfaceWarper<T>::working_bytes(const NewView& view, int source_width,
                                            int source_height) {
  return 2 * ImageWarper<T>::held_bytes(view.width_px, view.height_px) +
         surface_map_bytes(source_width, source_height);
}

template <typename T>
SurfaceWarper<T>::SurfaceWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                const NewView& view, Execution& execution)
    : alpha_(view.alpha()),
      left_(source.left, source.left_disparity, view.from_left, frame_of(view),
            options_at(view.distance_from_left, options), execution, source.left_photograph),
      right_(source.right, source.right_disparity, view.from_right, frame_of(view),
             options_at(view.distance_from_right, options), execution, source.right_photograph) {}

template <typename T>
void SurfaceWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  const WarpedPairLayout at(width(), left_.channels());
  left_.warp(y, scratch, memory + at.left_colours, memory + at.left_nearness);
  right_.warp(y, scratch, memory + at.right_colours, memory + at.right_nearness);
}

template <typename T>
double SurfaceWarper<T>::coverage(const SurfaceEdge& edge) const {
  return kernels::joint_coverage(alpha_, left_.coverage(edge), right_.coverage(edge));
}

template class SurfaceWarper<std::uint8_t>;
template class SurfaceWarper<std::uint16_t>;
template class SurfaceWarper<float>;

}  // namespace vantage
