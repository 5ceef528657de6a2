#include "engine/synthesis/view_synthesizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "engine/error.h"
#include "engine/synthesis/pair_warpers.h"
#include "engine/synthesis/view_assembly.h"
#include "engine/synthesis/view_finisher.h"
#include "engine/synthesis/view_sampling.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "engine/view_geometry/view_pose.h"
#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {
namespace {

void require_size_of_left(const Photograph& left, const char* what, int width, int height) {
  if (width != left.width() || height != left.height()) {
    throw Error(fmt::format("{} is {}×{}, expected {}×{} as the left image", what, width, height,
                            left.width(), left.height()));
  }
}

void require_same_shape(const Photograph& left, const Photograph& right) {
  if (left.width() < 1 || left.height() < 1) {
    throw Error("left image is empty, expected at least one pixel");
  }
  require_size_of_left(left, "right image", right.width(), right.height());
  if (left.channels() != right.channels()) {
    throw Error(fmt::format("right image has {} channels, expected {} as the left image",
                            right.channels(), left.channels()));
  }
  if (left.pixels.index() != right.pixels.index()) {
    throw Error("right image has another depth than the left image, expected the same");
  }
  if (left.channels() != 1 && left.channels() != 3 && left.channels() != 4) {
    throw Error(fmt::format("left image has {} channels, expected 1, 3 or 4", left.channels()));
  }
}

/// `map_px` belongs to an image of the size of `left`.
void require_map(const Photograph& left, const char* what, ImageView<const float> map_px) {
  require_size_of_left(left, what, map_px.width(), map_px.height());
  if (map_px.channels() != 1) {
    throw Error("disparity map has several channels, expected one");
  }
}

/// The photographs and maps of one call.
struct PairOfMaps {
  const Photograph& left;
  const Photograph& right;
  ImageView<const float> left_disparity;
  ImageView<const float> right_disparity;
  PhotographGeometry left_geometry = {};
  PhotographGeometry right_geometry = {};
};

void check_geometry(const Photograph& photograph, const PhotographGeometry& geometry,
                    ImageView<const float> map_px) {
  const auto require_size = [](ImageView<const float> image, int width, int height) {
    if (image.width() != width || image.height() != height) {
      throw Error(fmt::format("geometry of a photograph is {}×{}, expected {}×{}", image.width(),
                              image.height(), width, height));
    }
  };
  require_size(geometry.positions.x_px, map_px.width(), map_px.height());
  require_size(geometry.positions.y_px, map_px.width(), map_px.height());
  require_size(geometry.disparity_px, photograph.width(), photograph.height());
}

/// What colours are taken from. Throws Error if photographs do not match their maps.
PairOfMaps pair_of(const ViewSource& source, const SynthesisOptions& options) {
  if (!source.photographs) {
    return {source.left, source.right, source.left_disparity_px, source.right_disparity_px};
  }
  if (options.warp != WarpColour::kOnePass) {
    throw Error("colours come from photographs that are not rectified, expected warp one-pass");
  }
  const UnrectifiedPair& from = *source.photographs;
  check_geometry(from.left, from.left_geometry, source.left_disparity_px);
  check_geometry(from.right, from.right_geometry, source.right_disparity_px);
  return {
      from.left,          from.right,         source.left_disparity_px, source.right_disparity_px,
      from.left_geometry, from.right_geometry};
}

/// Forward mapping moves whole pixels, so supersampling does not apply.
ViewSampling sampling_of(const PairOfMaps& pair, const SynthesisOptions& options,
                         const NewView& view) {
  return options.warp == WarpColour::kOnePass
             ? view_sampling(view, pair.left_disparity, pair.right_disparity)
             : ViewSampling{};
}

/// XS of a view that RowPairWarper can make: on the baseline, with the images' orientation, focal
/// length and size. At a camera's position, colours of an unrectified photograph need
/// SurfaceWarper, where nothing is occluded.
std::optional<double> scanline_position(const NewView& view, const PairOfMaps& pair) {
  const auto moves_along_rows = [](const ViewWarp& warp) {
    return warp.is_translation() && warp.parallax.y() == 0;
  };
  const double view_x = -view.from_left.parallax.x();
  const bool stands_at_photograph =
      !pair.left_geometry.empty() &&
      (std::abs(view_x) < kSamePlace || std::abs(view_x - 1) < kSamePlace);
  if (moves_along_rows(view.from_left) && moves_along_rows(view.from_right) &&
      view.from_right.parallax.x() == -(view_x - 1) && view.infinity_disparity_px == 0 &&
      view.width_px == pair.left.width() && view.height_px == pair.left.height() &&
      !stands_at_photograph) {
    return view_x;
  }
  return std::nullopt;
}

/// Checks the pair, then calls body(source) with its images in their pixel type.
template <typename Body>
void with_source(const PairOfMaps& pair, const Body& body) {
  require_same_shape(pair.left, pair.right);
  // Geometries of photographs were checked with their maps.
  if (pair.left_geometry.empty()) {
    require_map(pair.left, "left disparity map", pair.left_disparity);
  }
  if (pair.right_geometry.empty()) {
    require_map(pair.left, "right disparity map", pair.right_disparity);
  }
  std::visit(
      [&]<typename T>(const Image<T>& left_image) {
        body(StereoSource<T>{.left = left_image.view(),
                             .right = std::get<Image<T>>(pair.right.pixels).view(),
                             .left_disparity = pair.left_disparity,
                             .right_disparity = pair.right_disparity,
                             .left_photograph = pair.left_geometry,
                             .right_photograph = pair.right_geometry});
      },
      pair.left.pixels);
}

/// Checks the pair, then calls body(synthesis) with a ViewAssembly of its pixel type.
template <typename Body>
void with_synthesis(const PairOfMaps& pair, const SynthesisOptions& options, const NewView& view,
                    Execution& execution, const Body& body) {
  with_source(pair, [&]<typename T>(const StereoSource<T>& source) {
    const auto assemble = [&]<typename Warper>(const Warper& warper) {
      body(ViewAssembly<T, Warper>(warper, options, source.left.channels(), execution));
    };
    if (const std::optional<double> view_x = scanline_position(view, pair)) {
      assemble(RowPairWarper<T>(source, options, *view_x));
    } else {
      assemble(SurfaceWarper<T>(source, options, view, execution));
    }
  });
}

/// Checks the triple, then calls body(synthesis) with a ViewAssembly of its pixel type.
template <typename Body>
void with_synthesis(const PhotographTriple& triple, const SynthesisOptions& options,
                    const TripleView& view, const std::array<IntensityFit, 4>& second_on_first,
                    Execution& execution, const Body& body) {
  const Photograph& first = *triple.images[0];
  for (std::size_t k = 0; k < triple.images.size(); ++k) {
    require_same_shape(first, *triple.images[k]);
    require_map(first, k == 0 ? "left disparity map" : "right disparity map",
                triple.disparity_px[k]);
  }
  std::visit(
      [&]<typename T>(const Image<T>& /*image*/) {
        TripleSource<T> source{.images = {}, .disparity_px = triple.disparity_px};
        for (std::size_t k = 0; k < triple.images.size(); ++k) {
          source.images[k] = std::get<Image<T>>(triple.images[k]->pixels).view();
        }
        const TripleWarper<T> warper(source, second_on_first, options, view, execution);
        body(ViewAssembly<T, TripleWarper<T>>(warper, options, first.channels(), execution));
      },
      first.pixels);
}

/// A view that needs only one sample per pixel.
void sample_at(const PairOfMaps& pair, const SynthesisOptions& options, const NewView& new_view,
               Execution& execution, SynthesizedView& view,
               const std::array<IntensityFit, 4>* given_fit) {
  with_synthesis(pair, options, new_view, execution,
                 [&]<typename T, typename Warper>(ViewAssembly<T, Warper>&& synthesis) {
                   synthesis.run(pixels_of<T>(view.image), view, given_fit);
                 });
}

}  // namespace

ViewSynthesizer::ViewSynthesizer(const SynthesisOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
}

std::size_t ViewSynthesizer::working_bytes(const NewView& view, int width, int height,
                                           int channels) {
  const int samples = max_samples_per_side(view, width, height);
  const NewView fine = with_samples(view, samples);
  const std::size_t sampled_bytes = samples == 1
                                        ? 0
                                        : (sizeof(float) * static_cast<std::size_t>(channels) + 2) *
                                              static_cast<std::size_t>(fine.width_px) *
                                              static_cast<std::size_t>(fine.height_px);
  return sampled_bytes +
         ViewFinisher<float>::surface_outline_bytes(fine.width_px, fine.height_px, channels) +
         SurfaceWarper<float>::working_bytes(fine, width, height);
}

std::size_t ViewSynthesizer::filling_bytes(const SynthesisOptions& options, int width, int height,
                                           int channels) {
  return ViewFinisher<float>::working_bytes(options, width, height, channels);
}

std::size_t ViewSynthesizer::filling_bytes(const SynthesisOptions& options, const NewView& view,
                                           int width, int height, int channels) {
  const NewView fine = with_samples(view, max_samples_per_side(view, width, height));
  return filling_bytes(options, fine.width_px, fine.height_px, channels);
}

void ViewSynthesizer::synthesize(const ViewSource& source, const NewView& new_view,
                                 SynthesizedView& view,
                                 const std::array<IntensityFit, 4>* given_fit) const {
  const PairOfMaps pair = pair_of(source, options_);
  const ViewSampling sampling = sampling_of(pair, options_, new_view);
  if (sampling.samples == 1) {
    sample_at(pair, options_, new_view, execution_, view, given_fit);
    return;
  }
  SynthesizedView fine;
  sample_at(pair, options_, with_samples(new_view, sampling.samples), execution_, fine, given_fit);
  reduce_view(fine, sampling, view, execution_);
}

void ViewSynthesizer::synthesize(const PhotographTriple& triple, const TripleView& new_view,
                                 SynthesizedView& view, const TripleFit& fit) const {
  SynthesisOptions options = options_;
  options.gamma.reset();
  with_synthesis(triple, options, new_view, fit.second_on_first, execution_,
                 [&]<typename T, typename Warper>(ViewAssembly<T, Warper>&& synthesis) {
                   synthesis.run(pixels_of<T>(view.image), view, &fit.third_on_others);
                 });
}

TripleFit ViewSynthesizer::fit_triple(const PhotographTriple& triple,
                                      const TripleView& new_view) const {
  TripleFit fit;
  if (!options_.match_intensities) {
    return fit;
  }
  const Photograph& first = *triple.images[0];
  const NewView first_two{.width_px = new_view.width_px,
                          .height_px = new_view.height_px,
                          .from_left = new_view.from[0],
                          .from_right = new_view.from[1]};
  fit.second_on_first = fit_channels(
      intensity_sums({first, *triple.images[1], triple.disparity_px[0], triple.disparity_px[1]},
                     first_two),
      first.channels(), 1);
  with_synthesis(triple, options_, new_view, fit.second_on_first, execution_,
                 [&]<typename T, typename Warper>(ViewAssembly<T, Warper>&& synthesis) {
                   fit.third_on_others =
                       fit_channels(grey_level_sums(synthesis), first.channels(), 1);
                 });
  return fit;
}

kernels::IntensitySums ViewSynthesizer::intensity_sums(const ViewSource& source,
                                                       const NewView& new_view) const {
  const PairOfMaps pair = pair_of(source, options_);
  const ViewSampling sampling = sampling_of(pair, options_, new_view);
  kernels::IntensitySums sums;
  with_synthesis(pair, options_,
                 sampling.samples == 1 ? new_view : with_samples(new_view, sampling.samples),
                 execution_, [&]<typename T, typename Warper>(ViewAssembly<T, Warper>&& synthesis) {
                   sums = grey_level_sums(synthesis);
                 });
  return sums;
}

}  // namespace vantage
