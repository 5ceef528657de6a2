#include "engine/synthesis/blended_warper.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>

#include "engine/error.h"
#include "engine/synthesis/view_assembly.h"
#include "engine/synthesis/view_finisher.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/surface_coverage/surface_coverage.h"

namespace vantage {
namespace {

constexpr float kMinSupport = 0.3F;
/// Smaller angles, in radians, and distances, in that of the farthest camera, count as this one: a
/// fraction of a pixel.
constexpr double kMinAside = 1e-5;

double farthest_distance(std::span<const BlendSource> sources) {
  double largest = 0;
  for (const BlendSource& source : sources) {
    largest = std::max(largest, source.centre.norm());
  }
  return largest > 0 ? largest : 1;
}

/// Of a camera so far from a line of sight, in that of the farthest camera, under an angle between
/// the two rays. Whatever is wrong with a map moves colours by as much as their camera is aside, so
/// the variance of what it shows has this square as a factor.
double weight_of(double share, double aside, double angle) {
  const double counted = std::max(aside, kMinAside);
  return share / (counted * counted * std::max(angle, kMinAside));
}

/// Weights of the sources over the whole view: as at one point at a typical depth, in the middle.
std::vector<double> whole_weights(std::span<const BlendSource> sources) {
  const double farthest = farthest_distance(sources);
  std::vector<double> weights;
  double sum = 0;
  for (const BlendSource& source : sources) {
    const double aside = source.centre.norm() / farthest;
    weights.push_back(weight_of(source.share, aside, aside));
    sum += weights.back();
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

}  // namespace

template <typename T>
BlendedWarper<T>::BlendedWarper(std::span<const BlendSource> sources,
                                const SynthesisOptions& options, const BlendedView& view,
                                Execution& execution)
    : view_(view),
      gradient_limit_px_(static_cast<float>(options.disparity_gradient_limit_px)),
      sources_(sources.begin(), sources.end()),
      weights_(whole_weights(sources)),
      farthest_(farthest_distance(sources)),
      transforms_(sources.size()) {
  const ViewFrame frame{.width_px = view.width_px, .height_px = view.height_px};
  // Distances are compared with each other: scenes have any unit.
  const double same_place = kSamePlace * farthest_;
  for (const BlendSource& source : sources) {
    SynthesisOptions own = options;
    if (source.centre.norm() <= same_place) {
      is_at_source_ = true;
      own.disparity_gradient_limit_px = std::numeric_limits<double>::infinity();
    }
    images_.emplace_back(std::get<Image<T>>(source.image->pixels).view(), source.disparity_px,
                         source.warp, frame, own, execution);
  }
  trust_at_ends_ = ViewFinisher<T>::trust_at_ends(options, alpha());
  // I_k = a_k + b_k I_1, so I = a + b (I_k − a_k) / b_k with the blended a and b.
  for (std::size_t c = 0; c < 4; ++c) {
    double offset = 0;
    double gain = 0;
    for (std::size_t k = 0; k < sources_.size(); ++k) {
      offset += weights_[k] * sources_[k].on_first[c].offset / double{kGreyLevelsPerUnit<T>};
      gain += weights_[k] * sources_[k].on_first[c].gain;
    }
    for (std::size_t k = 0; k < sources_.size(); ++k) {
      const double a = sources_[k].on_first[c].offset / double{kGreyLevelsPerUnit<T>};
      const double b = sources_[k].on_first[c].gain;
      transforms_[k].scale[c] = static_cast<float>(gain / b);
      transforms_[k].offset[c] = static_cast<float>(offset - gain * a / b);
    }
  }
}

template <typename T>
std::size_t BlendedWarper<T>::floats_per_image() const {
  return row_floats(width(), kernels::pixel_lanes(images_.front().channels())) +
         row_floats(width(), 1);
}

template <typename T>
std::size_t BlendedWarper<T>::scratch_floats() const {
  return images_.size() * floats_per_image() + images_.front().scratch_floats();
}

template <typename T>
bool BlendedWarper<T>::goes_on(const float* nearness, int x) const {
  const float before = nearness[std::max(x - 1, 0)];
  const float after = nearness[std::min(x + 1, width() - 1)];
  return std::abs(before - nearness[x]) <= gradient_limit_px_ &&
         std::abs(after - nearness[x]) <= gradient_limit_px_;
}

template <typename T>
void BlendedWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  const int lanes = kernels::pixel_lanes(images_.front().channels());
  const std::size_t count = images_.size();
  const std::size_t colour_floats = row_floats(width(), lanes);
  const auto colours_of = [&](std::size_t k) { return scratch.data() + k * floats_per_image(); };
  const auto nearness_of = [&](std::size_t k) { return colours_of(k) + colour_floats; };
  for (std::size_t k = 0; k < count; ++k) {
    images_[k].warp(y, scratch.subspan(count * floats_per_image()), colours_of(k), nearness_of(k));
  }
  const WarpedPairLayout out(width(), images_.front().channels());
  float* colours = memory + out.left_colours;
  float* nearness = memory + out.left_nearness;
  constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(memory + out.right_colours, colour_floats, 0.0F);
  std::fill_n(memory + out.right_nearness, width(), kHole);
  std::vector<float> weights(count);
  for (int x = 0; x < width(); ++x) {
    const Eigen::Vector3d ray = view_.ray_of_pixel * Eigen::Vector3d(x, y, 1);
    const Eigen::Vector3d direction = ray.normalized();
    float all = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const float q = nearness_of(k)[x];
      weights[k] = 0;
      if (std::isnan(q)) {
        continue;
      }
      const Eigen::Vector3d& centre = sources_[k].centre;
      // Both rays scaled by q, so that infinity is no special case. The chord of the angle will do.
      const Eigen::Vector3d own = view_.scale_px * ray - double{q} * centre;
      const double angle = (own.normalized() - direction).norm();
      const double aside = direction.cross(centre).norm() / farthest_;
      weights[k] = static_cast<float>(weight_of(sources_[k].share, aside, angle)) *
                   (goes_on(nearness_of(k), x) ? 1.0F : trust_at_ends_);
      all += weights[k];
    }
    const auto support_of = [&](float q) {
      float support = 0;
      for (std::size_t k = 0; k < count; ++k) {
        if (std::abs(nearness_of(k)[x] - q) <= gradient_limit_px_) {
          support += weights[k];
        }
      }
      return support;
    };
    float surface = kHole;
    float support_of_surface = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const float q = nearness_of(k)[x];
      if (std::isnan(q)) {
        continue;
      }
      const float support = support_of(q);
      const bool is_sure = support >= kMinSupport * all;
      const bool was_sure = support_of_surface >= kMinSupport * all;
      if (std::isnan(surface) || (is_sure && (!was_sure || q > surface)) ||
          (!is_sure && !was_sure && support > support_of_surface)) {
        surface = q;
        support_of_surface = support;
      }
    }
    nearness[x] = surface;
    float* pixel = colours + x * lanes;
    std::fill_n(pixel, lanes, 0.0F);
    if (std::isnan(surface)) {
      continue;
    }
    float blended = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const float q = nearness_of(k)[x];
      if (!(std::abs(q - surface) <= gradient_limit_px_)) {
        continue;
      }
      const float share = weights[k] / support_of_surface;
      blended += share * q;
      for (int c = 0; c < lanes; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        pixel[c] += share * (transforms_[k].scale[channel] * colours_of(k)[x * lanes + c] +
                             transforms_[k].offset[channel]);
      }
    }
    nearness[x] = blended;
  }
}

template <typename T>
double BlendedWarper<T>::coverage(const SurfaceEdge& edge) const {
  double covered = std::numeric_limits<double>::quiet_NaN();
  double weight = 0;
  for (std::size_t k = 0; k < images_.size(); ++k) {
    const double own = images_[k].coverage(edge);
    if (!std::isnan(own)) {
      covered = kernels::joint_coverage(weight / (weight + weights_[k]), covered, own);
      weight += weights_[k];
    }
  }
  return covered;
}

template class BlendedWarper<std::uint8_t>;
template class BlendedWarper<std::uint16_t>;
template class BlendedWarper<float>;

BlendedSynthesizer::BlendedSynthesizer(const SynthesisOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
  options_.gamma.reset();
}

void BlendedSynthesizer::synthesize(std::span<const BlendSource> sources,
                                    const BlendedView& new_view, SynthesizedView& view) const {
  const Photograph& first = *sources.front().image;
  for (const BlendSource& source : sources) {
    const Photograph& image = *source.image;
    if (image.width() != first.width() || image.height() != first.height() ||
        image.channels() != first.channels() || image.pixels.index() != first.pixels.index()) {
      throw Error("the photographs of a view differ in size, channels or depth, expected the same");
    }
    if (source.disparity_px.width() != first.width() ||
        source.disparity_px.height() != first.height()) {
      throw Error(fmt::format("disparity map is {}×{}, expected {}×{} as the image",
                              source.disparity_px.width(), source.disparity_px.height(),
                              first.width(), first.height()));
    }
  }
  std::visit(
      [&]<typename T>(const Image<T>& /*image*/) {
        const BlendedWarper<T> warper(sources, options_, new_view, execution_);
        constexpr std::array<IntensityFit, 4> kAsTheyAre{};
        ViewAssembly<T, BlendedWarper<T>>(warper, options_, first.channels(), execution_)
            .run(pixels_of<T>(view.image), view, &kAsTheyAre);
      },
      first.pixels);
}

}  // namespace vantage
