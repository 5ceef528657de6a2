#include "engine/synthesis/view_sampling.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

constexpr int kMaxSamples = 8;
constexpr int kLargestSide = 65500;

// Excess over a whole number that needs no further sample: there is little aliasing.
constexpr double kToleratedReduction = 0.2;

// Grid spacing along both axes at which the reduction is measured.
constexpr int kGridPx = 32;

// Largest expected disparity, as a share of the image's width.
constexpr double kLargestDisparity = 0.25;

/// Area of a view, and the sum over that area of the images' reduction.
struct Reduction {
  double area = 0;
  double sum = 0;

  void add(const Reduction& other, double weight) {
    area += weight * other.area;
    sum += weight * other.sum;
  }
  [[nodiscard]] double mean() const { return area > 0 ? sum / area : 1; }
};

// disparity(x, y): NaN or ±inf where unknown.
template <typename Disparity>
Reduction reduction_of(const ViewWarp& warp, const NewView& view, int width, int height,
                       const Disparity& disparity) {
  Reduction result;
  for (int y = std::min(kGridPx, height) / 2; y < height; y += kGridPx) {
    for (int x = std::min(kGridPx, width) / 2; x < width; x += kGridPx) {
      const double d = disparity(x, y);
      if (!std::isfinite(d)) {
        continue;
      }
      const Eigen::Vector3d at = warp.homography * Eigen::Vector3d(x, y, 1) + d * warp.parallax;
      const Eigen::Vector2d target = at.head<2>() / at.z();
      if (!(at.z() > 0) || !(target.x() > -0.5) || !(target.x() < view.width_px - 0.5) ||
          !(target.y() > -0.5) || !(target.y() < view.height_px - 0.5)) {
        continue;
      }
      // ∂(u, v) / ∂(x, y)
      const Eigen::Matrix2d growth = (warp.homography.topLeftCorner<2, 2>() -
                                      target * warp.homography.bottomLeftCorner<1, 2>()) /
                                     at.z();
      // A small circle becomes an ellipse of area `min` · `max`, which reduces by 1 / `min`.
      const double area = std::abs(growth.determinant());
      const double squares = growth.squaredNorm();
      const double max = std::sqrt(
          0.5 * (squares + std::sqrt(std::max(squares * squares - 4 * area * area, 0.0))));
      result.area += area;
      result.sum += max;
    }
  }
  return result;
}

int samples_for(double reduction, const NewView& view) {
  const int largest_side = std::max(view.width_px, view.height_px);
  const int max = std::clamp(kLargestSide / std::max(largest_side, 1), 1, kMaxSamples);
  const double wanted = std::ceil(reduction - kToleratedReduction);
  return wanted > 1 ? static_cast<int>(std::min(wanted, 1.0 * max)) : 1;  // 1 also for NaN
}

bool keeps_sizes(const NewView& view) {
  return view.from_left.is_translation() && view.from_right.is_translation();
}

/// Weights of the samples along a line through a pixel; the outermost samples are the neighbours'.
///
/// Variances add up: a pixel of the view has m²/12 in image pixels, where m is the reduction;
/// interpolated samples contribute 1/12, so their positions must contribute (m² − 1)/12. Equal
/// weights for m samples of a pixel do.
class SampleWeights {
 public:
  explicit SampleWeights(const ViewSampling& sampling) : count_(sampling.samples + 2) {
    const double samples = sampling.samples;
    const double distance = sampling.reduction / samples;  // between two samples, in image pixels
    const double wanted =
        (sampling.reduction * sampling.reduction - 1) / (12 * distance * distance);
    const double own = (samples * samples - 1) / 12;  // with equal weights
    const double beside = (samples + 1) * (samples + 1) / 4;
    const double outer = (wanted - own) / (2 * (beside - own));
    std::fill_n(weights_.begin(), count_, static_cast<float>((1 - 2 * outer) / samples));
    weights_.front() = weights_[static_cast<std::size_t>(count_ - 1)] = static_cast<float>(outer);
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] float operator[](int sample) const {
    return weights_[static_cast<std::size_t>(sample)];
  }

 private:
  int count_;
  std::array<float, kMaxSamples + 2> weights_{};
};

// `line`: memory for the values of a row of `fine`.
template <typename T>
void reduce_row(const Image<T>& fine, const SampleWeights& weights, int y, float* line,
                Image<T>& image) {
  const int samples = weights.count() - 2;
  const int channels = fine.channels();
  const int values = fine.width() * channels;
  std::fill_n(line, values, 0.0F);
  for (int j = 0; j < weights.count(); ++j) {
    const T* from = fine.row(std::clamp(samples * y + j - 1, 0, fine.height() - 1));
    const float weight = weights[j];
    for (int k = 0; k < values; ++k) {
      line[k] += weight * static_cast<float>(from[k]);
    }
  }
  const float largest = 255 / kGreyLevelsPerUnit<T>;
  T* row = image.row(y);
  for (int x = 0; x < image.width(); ++x) {
    for (int c = 0; c < channels; ++c) {
      float sum = 0;
      for (int i = 0; i < weights.count(); ++i) {
        const int column = std::clamp(samples * x + i - 1, 0, fine.width() - 1);
        sum += weights[i] * line[column * channels + c];
      }
      if constexpr (std::is_integral_v<T>) {
        sum = std::clamp(sum, 0.0F, largest) + 0.5F;
      }
      row[x * channels + c] = static_cast<T>(sum);
    }
  }
}

// Calls add(value) for all samples of a pixel.
template <typename Add>
void for_each_sample(const Mask& fine, int samples, int x, int y, const Add& add) {
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      add(fine.at(samples * x + i, samples * y + j));
    }
  }
}

}  // namespace

ViewSampling view_sampling(const NewView& view, ImageView<const float> left_disparity_px,
                           ImageView<const float> right_disparity_px) {
  if (keeps_sizes(view)) {
    return {};
  }
  const auto of_map = [&](const ViewWarp& warp, ImageView<const float> map_px) {
    return reduction_of(warp, view, map_px.width(), map_px.height(),
                        [&](int x, int y) { return double{map_px.at(x, y)}; });
  };
  Reduction reduction;
  reduction.add(of_map(view.from_left, left_disparity_px), view.alpha());
  reduction.add(of_map(view.from_right, right_disparity_px), 1 - view.alpha());
  const int samples = samples_for(reduction.mean(), view);
  if (samples == 1) {
    return {};
  }
  const int max = max_samples_per_side(view, left_disparity_px.width(), left_disparity_px.height());
  return {.samples = std::min(samples, max), .reduction = reduction.mean()};
}

int max_samples_per_side(const NewView& view, int source_width, int source_height) {
  if (keeps_sizes(view)) {
    return 1;
  }
  double max = 1;
  for (const double nearest : {0.0, kLargestDisparity * source_width}) {
    for (const ViewWarp* warp : {&view.from_left, &view.from_right}) {
      max = std::max(max, reduction_of(*warp, view, source_width, source_height, [&](int, int) {
                            return view.infinity_disparity_px + nearest;
                          }).mean());
    }
  }
  return samples_for(max, view);
}

NewView with_samples(const NewView& view, int samples) {
  Eigen::Matrix3d finer = Eigen::Matrix3d::Identity();
  finer(0, 0) = finer(1, 1) = samples;
  finer(0, 2) = finer(1, 2) = 0.5 * (samples - 1);
  NewView result = view;
  result.width_px = samples * view.width_px;
  result.height_px = samples * view.height_px;
  for (ViewWarp* warp : {&result.from_left, &result.from_right}) {
    warp->homography = finer * warp->homography;
    warp->parallax = finer * warp->parallax;
  }
  return result;
}

void reduce_view(const SynthesizedView& fine, const ViewSampling& sampling, SynthesizedView& view,
                 Execution& execution) {
  const int samples = sampling.samples;
  const SampleWeights weights(sampling);
  const int width = fine.image.width() / samples;
  const int height = fine.image.height() / samples;
  view.holes.resize(width, height);
  view.sources.resize(width, height);
  view.intensity = fine.intensity;
  std::visit(
      [&]<typename T>(const Image<T>& fine_image) {
        Image<T>& image = pixels_of<T>(view.image);
        image.resize(width, height, fine_image.channels());
        execution.for_each_band(height, [&](int first_row, int end_row) {
          const auto memory = execution.scratch().lease(
              sizeof(float) * static_cast<std::size_t>(fine_image.width()) *
              static_cast<std::size_t>(fine_image.channels()));
          auto* line = reinterpret_cast<float*>(memory.data());
          for (int y = first_row; y < end_row; ++y) {
            reduce_row(fine_image, weights, y, line, image);
            for (int x = 0; x < width; ++x) {
              unsigned holes = 255;
              unsigned sources = 0;
              for_each_sample(fine.holes, samples, x, y, [&](unsigned value) { holes &= value; });
              for_each_sample(fine.sources, samples, x, y,
                              [&](unsigned value) { sources |= value; });
              view.holes.at(x, y) = static_cast<std::uint8_t>(holes);
              view.sources.at(x, y) = static_cast<std::uint8_t>(sources);
            }
          }
        });
      },
      fine.image.pixels);
  std::int64_t holes = 0;
  for (int y = 0; y < height; ++y) {
    holes += std::count(view.holes.row(y), view.holes.row(y) + width, std::uint8_t{255});
  }
  view.hole_fraction = static_cast<double>(holes) / (static_cast<double>(width) * height);
}

}  // namespace vantage
