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
#include "engine/synthesis/row_pair_warper.h"
#include "kernels/hole_fill/hole_fill.h"
#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {
namespace {

constexpr double kFarthestView = 16;  // baselines

/// Warped rows are kept between the two passes over an image as long as the caches hold a good part
/// of them: more would take several times the memory of all inputs, and as long as warping again.
constexpr std::size_t kMostKeptBytes = std::size_t{32} << 20;

void require_same_shape(const Photograph& left, const Photograph& right,
                        ImageView<const float> left_disparity,
                        ImageView<const float> right_disparity) {
  const auto require_size = [&](const char* what, int width, int height) {
    if (width != left.width() || height != left.height()) {
      throw Error(fmt::format("{} is {}×{}, expected {}×{} as the left image", what, width, height,
                              left.width(), left.height()));
    }
  };
  if (left.width() < 1 || left.height() < 1) {
    throw Error("left image is empty, expected at least one pixel");
  }
  require_size("right image", right.width(), right.height());
  require_size("left disparity map", left_disparity.width(), left_disparity.height());
  require_size("right disparity map", right_disparity.width(), right_disparity.height());
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
  if (left_disparity.channels() != 1 || right_disparity.channels() != 1) {
    throw Error("disparity map has several channels, expected one");
  }
}

// What the parallel passes leave behind per row; reduced in the order of rows.
struct RowRecord {
  kernels::IntensitySums sums;
  int holes = 0;
};

// (3.12): each image's colours move towards the other's by its share of γ.
kernels::BlendWeights blend_weights(const std::array<IntensityFit, 4>& intensity, double view_x,
                                    std::optional<double> chosen_gamma,
                                    double grey_levels_per_unit) {
  // (3.13), (3.14) for YS = 0.
  const double left_distance = std::abs(view_x);
  const double right_distance = std::abs(view_x - 1);
  const double alpha = right_distance / (left_distance + right_distance);
  const double gamma = chosen_gamma.value_or(alpha);

  kernels::BlendWeights weights;
  weights.alpha = static_cast<float>(alpha);
  for (std::size_t c = 0; c < intensity.size(); ++c) {
    const double a = intensity[c].offset / grey_levels_per_unit;
    const double b = intensity[c].gain;
    weights.left_scale[c] = static_cast<float>(gamma + (1 - gamma) * b);
    weights.left_offset[c] = static_cast<float>((1 - gamma) * a);
    weights.right_scale[c] = static_cast<float>(gamma / b + (1 - gamma));
    weights.right_offset[c] = static_cast<float>(-gamma * a / b);
  }
  return weights;
}

template <typename T>
class Synthesis {
 public:
  Synthesis(const StereoSource<T>& source, const SynthesisOptions& options, double view_x,
            Execution& execution)
      : source_(source),
        options_(options),
        view_x_(view_x),
        execution_(execution),
        width_(source.left.width()),
        height_(source.left.height()),
        channels_(source.left.channels()),
        records_memory_(
            execution.scratch().lease(sizeof(RowRecord) * static_cast<std::size_t>(height_))),
        records_(reinterpret_cast<RowRecord*>(records_memory_.data()),
                 static_cast<std::size_t>(height_)) {
    std::uninitialized_fill(records_.begin(), records_.end(), RowRecord{});
  }

  void run(Image<T>& image, SynthesizedView& view, const std::array<IntensityFit, 4>* given_fit) {
    view.intensity = {};
    if (given_fit != nullptr) {
      view.intensity = *given_fit;
    } else if (options_.match_intensities) {
      keep_warped_rows();
      view.intensity = fit_channels(intensity_sums(), channels_, double{kGreyLevelsPerUnit<T>});
    }
    image.resize(width_, height_, channels_);
    view.holes.resize(width_, height_);
    combine(view.intensity, image, view.holes);
    if (options_.holes != HoleFilling::kNone) {
      fill_empty_rows(image);
    }
    std::int64_t holes = 0;
    for (const RowRecord& record : records_) {
      holes += record.holes;
    }
    view.hole_fraction = static_cast<double>(holes) / (static_cast<double>(width_) * height_);
  }

  kernels::IntensitySums intensity_sums() {
    for_each_warped_row([&](int y, const kernels::WarpedPairRow& pair) {
      records_[static_cast<std::size_t>(y)].sums = kernels::intensity_sums_row(pair);
    });
    kernels::IntensitySums total;
    for (const RowRecord& record : records_) {
      total.add(record.sums);
    }
    return total;
  }

 private:
  // So that they need not be warped again.
  void keep_warped_rows() {
    const std::size_t bytes = ViewSynthesizer::working_bytes(width_, height_, channels_);
    if (bytes > 0) {
      kept_memory_ = execution_.scratch().lease(bytes);
      kept_ = reinterpret_cast<float*>(kept_memory_.data());
    }
  }

  [[nodiscard]] std::size_t pair_floats() const {
    return RowPairWarper<T>::pair_floats(width_, channels_);
  }
  [[nodiscard]] float* kept_row(int y) const {
    return kept_ + pair_floats() * static_cast<std::size_t>(y);
  }

  // Calls body(y, warped scanline pair) for all rows.
  template <typename Body>
  void for_each_warped_row(const Body& body) {
    const std::size_t scratch_floats = RowPairWarper<T>::scratch_floats(width_, channels_);
    execution_.for_each_band(height_, [&](int first_row, int end_row) {
      const auto memory =
          execution_.scratch().lease((scratch_floats + pair_floats()) * sizeof(float));
      auto* scratch = reinterpret_cast<float*>(memory.data());
      RowPairWarper<T> warper(source_, options_, view_x_, {scratch, scratch_floats});
      for (int y = first_row; y < end_row; ++y) {
        body(y, warper.warp(y, kept_ != nullptr ? kept_row(y) : scratch + scratch_floats));
      }
    });
  }

  // The same once they have been warped, if they were kept.
  template <typename Body>
  void for_each_warped_row_again(const Body& body) {
    if (kept_ == nullptr) {
      for_each_warped_row(body);
      return;
    }
    execution_.for_each_band(height_, [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        body(y, RowPairWarper<T>::warped_in(source_, options_, kept_row(y)));
      }
    });
  }

  void combine(const std::array<IntensityFit, 4>& intensity, Image<T>& image, Mask& holes) {
    const kernels::BlendWeights weights =
        blend_weights(intensity, view_x_, options_.gamma, double{kGreyLevelsPerUnit<T>});
    for_each_warped_row_again([&](int y, const kernels::WarpedPairRow& pair) {
      const auto memory =
          execution_.scratch().lease(static_cast<std::size_t>(width_) * sizeof(float));
      auto* disparity_px = reinterpret_cast<float*>(memory.data());
      const int row_holes = kernels::blend_row(
          pair, weights, channels_,
          kernels::BlendedRow<T>{
              .pixels = image.row(y), .disparity_px = disparity_px, .holes = holes.row(y)});
      records_[static_cast<std::size_t>(y)].holes = row_holes;
      if (row_holes > 0 && options_.holes != HoleFilling::kNone) {
        kernels::fill_holes_row(
            kernels::HoleFillRow<T>{.pixels = image.row(y),
                                    .disparity_px = disparity_px,
                                    .width = width_,
                                    .channels = channels_,
                                    .gradient_limit_px = pair.gradient_limit_px},
            options_.holes == HoleFilling::kMirror);
      }
    });
  }

  [[nodiscard]] bool empty_row(int y) const {
    return records_[static_cast<std::size_t>(y)].holes == width_;
  }

  // A row without any pixel takes the nearest row that has one, the upper of two.
  void fill_empty_rows(Image<T>& image) {
    const std::size_t values =
        static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
    int y = 0;
    while (y < height_) {
      const int begin = y;
      while (y < height_ && empty_row(y)) {
        ++y;
      }
      const bool has_upper = begin > 0;
      const bool has_lower = y < height_;
      for (int row = begin; row < y && (has_upper || has_lower); ++row) {
        const bool from_upper = has_upper && (!has_lower || row - (begin - 1) <= y - row);
        std::copy_n(image.row(from_upper ? begin - 1 : y), values, image.row(row));
      }
      ++y;
    }
  }

  const StereoSource<T>& source_;
  const SynthesisOptions& options_;
  double view_x_;
  Execution& execution_;
  int width_;
  int height_;
  int channels_;
  scheduler::ScratchPool::Lease records_memory_;
  std::span<RowRecord> records_;
  scheduler::ScratchPool::Lease kept_memory_;
  float* kept_ = nullptr;  // warped scanline pairs of all rows, where they are kept
};

/// The photographs and maps of one call.
struct PairOfMaps {
  const Photograph& left;
  const Photograph& right;
  ImageView<const float> left_disparity;
  ImageView<const float> right_disparity;
};

/// Checks the pair and the position, then calls body(synthesis) with a Synthesis of its pixel type.
template <typename Body>
void with_synthesis(const PairOfMaps& pair, const SynthesisOptions& options, double view_x,
                    Execution& execution, const Body& body) {
  if (!(std::abs(view_x) <= kFarthestView)) {
    throw UsageError(fmt::format("view is at {} baselines, expected -{}..{}", view_x, kFarthestView,
                                 kFarthestView));
  }
  require_same_shape(pair.left, pair.right, pair.left_disparity, pair.right_disparity);
  std::visit(
      [&]<typename T>(const Image<T>& left_image) {
        const StereoSource<T> source{.left = left_image.view(),
                                     .right = std::get<Image<T>>(pair.right.pixels).view(),
                                     .left_disparity = pair.left_disparity,
                                     .right_disparity = pair.right_disparity};
        Synthesis<T> synthesis(source, options, view_x, execution);
        body(synthesis);
      },
      pair.left.pixels);
}

}  // namespace

ViewSynthesizer::ViewSynthesizer(const SynthesisOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
}

std::size_t ViewSynthesizer::working_bytes(int width, int height, int channels) {
  // Of any pixel type: rows are floats.
  const std::size_t bytes = RowPairWarper<float>::pair_floats(width, channels) * sizeof(float) *
                            static_cast<std::size_t>(height);
  return bytes <= kMostKeptBytes ? bytes : 0;
}

void ViewSynthesizer::synthesize(const Photograph& left, const Photograph& right,
                                 ImageView<const float> left_disparity,
                                 ImageView<const float> right_disparity, double view_x,
                                 SynthesizedView& view,
                                 const std::array<IntensityFit, 4>* given_fit) const {
  with_synthesis({left, right, left_disparity, right_disparity}, options_, view_x, execution_,
                 [&]<typename T>(Synthesis<T>& synthesis) {
                   if (!std::holds_alternative<Image<T>>(view.image.pixels)) {
                     view.image.pixels.template emplace<Image<T>>();
                   }
                   synthesis.run(std::get<Image<T>>(view.image.pixels), view, given_fit);
                 });
}

kernels::IntensitySums ViewSynthesizer::intensity_sums(const Photograph& left,
                                                       const Photograph& right,
                                                       ImageView<const float> left_disparity,
                                                       ImageView<const float> right_disparity,
                                                       double view_x) const {
  kernels::IntensitySums sums;
  with_synthesis({left, right, left_disparity, right_disparity}, options_, view_x, execution_,
                 [&]<typename T>(Synthesis<T>& synthesis) {
                   sums = synthesis.intensity_sums();
                   const double unit{kGreyLevelsPerUnit<T>};
                   for (int c = 0; c < 4; ++c) {
                     sums.left[c] *= unit;
                     sums.right[c] *= unit;
                     sums.left_right[c] *= unit * unit;
                     sums.left_left[c] *= unit * unit;
                   }
                 });
  return sums;
}

}  // namespace vantage
