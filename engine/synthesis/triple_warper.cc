#include "engine/synthesis/triple_warper.h"

#include <algorithm>
#include <cstdint>

#include "engine/image/photograph.h"
#include "engine/synthesis/view_finisher.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/surface_coverage/surface_coverage.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {
namespace {

constexpr double kMinShare = 1e-6;

double share(const TripleView& view, double of_wanted, double of_others) {
  if (std::find(view.weights.begin(), view.weights.end(), 1.0) != view.weights.end()) {
    return of_wanted > 0 ? 1 : 0;
  }
  const double sum = of_wanted + of_others;
  return sum > 0 ? std::clamp(of_wanted / sum, kMinShare, 1 - kMinShare) : 0.5;
}

/// Offsets of the parts of the scratch memory.
struct ScratchLayout {
  WarpedPairLayout pair;  ///< the first two images
  std::size_t holes;
  std::size_t warping;

  ScratchLayout(int width, int channels)
      : pair(width, channels),
        holes(pair.floats),
        warping(holes + row_floats(width / static_cast<int>(sizeof(float)) + 1, 1)) {}
};

template <typename T>
std::array<ImageWarper<T>, 3> warpers_of(const TripleSource<T>& source,
                                         const SynthesisOptions& options, const TripleView& view,
                                         Execution& execution) {
  const ViewFrame frame{.width_px = view.width_px, .height_px = view.height_px};
  const auto warper = [&](std::size_t k) {
    return ImageWarper<T>(source.images[k], source.disparity_px[k], view.from[k], frame, options,
                          execution);
  };
  return {warper(0), warper(1), warper(2)};
}

}  // namespace

double TripleView::alpha_of_first() const { return share(*this, weights[0], weights[1]); }

double TripleView::alpha_of_first_two() const {
  return share(*this, weights[0] + weights[1], weights[2]);
}

template <typename T>
TripleWarper<T>::TripleWarper(const TripleSource<T>& source,
                              const std::array<IntensityFit, 4>& second_on_first,
                              const SynthesisOptions& options, const TripleView& view,
                              Execution& execution)
    : alpha_(view.alpha_of_first_two()),
      alpha_of_first_(view.alpha_of_first()),
      trust_at_ends_(ViewFinisher<T>::trust_at_ends(options, alpha_of_first_)),
      gradient_limit_px_(static_cast<float>(options.disparity_gradient_limit_px)),
      images_(warpers_of(source, options, view, execution)) {
  const kernels::BlendWeights weights =
      blend_weights(second_on_first, alpha_of_first_, std::nullopt, double{kGreyLevelsPerUnit<T>});
  for (std::size_t c = 0; c < second_on_first.size(); ++c) {
    first_.scale[c] = weights.left_scale[c];
    first_.offset[c] = weights.left_offset[c];
    second_.scale[c] = weights.right_scale[c];
    second_.offset[c] = weights.right_offset[c];
  }
}

template <typename T>
std::size_t TripleWarper<T>::scratch_floats() const {
  return ScratchLayout(width(), images_[0].channels()).warping + images_[0].scratch_floats();
}

template <typename T>
void TripleWarper<T>::transform(const Transform& by, float* colours) const {
  const int lanes = kernels::pixel_lanes(images_[0].channels());
  for (int x = 0; x < width(); ++x) {
    for (int c = 0; c < lanes; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      colours[x * lanes + c] = by.scale[channel] * colours[x * lanes + c] + by.offset[channel];
    }
  }
}

template <typename T>
void TripleWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  const ScratchLayout at(width(), images_[0].channels());
  const std::span<float> warping = scratch.subspan(at.warping);
  float* pair = scratch.data();
  images_[0].warp(y, warping, pair + at.pair.left_colours, pair + at.pair.left_nearness);
  images_[1].warp(y, warping, pair + at.pair.right_colours, pair + at.pair.right_nearness);
  // Before blending, which only keeps results within its two inputs; other weights would limit them
  // to a photograph's range.
  transform(first_, pair + at.pair.left_colours);
  transform(second_, pair + at.pair.right_colours);

  const WarpedPairLayout out(width(), images_[0].channels());
  kernels::BlendWeights weights;
  weights.alpha = static_cast<float>(alpha_of_first_);
  weights.trust_at_ends = trust_at_ends_;
  kernels::BlendedRow<float> blended;
  blended.pixels = memory + out.left_colours;
  blended.disparity_px = memory + out.left_nearness;
  blended.holes = reinterpret_cast<std::uint8_t*>(pair + at.holes);
  kernels::blend_row(at.pair.row_in(pair, gradient_limit_px_), weights, at.pair.lanes, blended);
  images_[2].warp(y, warping, memory + out.right_colours, memory + out.right_nearness);
}

template <typename T>
double TripleWarper<T>::coverage(const SurfaceEdge& edge) const {
  const double of_first_two = kernels::joint_coverage(alpha_of_first_, images_[0].coverage(edge),
                                                      images_[1].coverage(edge));
  return kernels::joint_coverage(alpha_, of_first_two, images_[2].coverage(edge));
}

template class TripleWarper<std::uint8_t>;
template class TripleWarper<std::uint16_t>;
template class TripleWarper<float>;

}  // namespace vantage
