#include "engine/synthesis/pair_warpers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/synthesis/surface_map.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/forward_warp/forward_warp.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/source_position/source_position.h"
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
struct RowPairWarper<T>::SourceRow {
  const T* pixels;
  const float* map_px;
  double camera_offset;
  float* planes;          // of x = 0; margins on both sides
  std::ptrdiff_t stride;  // floats between planes
  float* disparity_px;    // also with margins
  float* column;
};

template <typename T>
RowPairWarper<T>::RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                double view_x)
    : source_(source), options_(options), view_x_(view_x) {}

template <typename T>
double RowPairWarper<T>::alpha() const {
  return share_of_left(std::abs(view_x_), std::abs(view_x_ - 1));
}

template <typename T>
std::size_t RowPairWarper<T>::scratch_floats() const {
  if (!source_.left_photograph.empty()) {
    return position_floats(width()) + row_floats(width(), 1);
  }
  return 2 * source_row_floats();
}

template <typename T>
std::size_t RowPairWarper<T>::source_row_floats() const {
  const int padded = width() + 2 * kernels::kRowMarginPx;
  return row_floats(padded, 1) * static_cast<std::size_t>(source_.left.channels() + 1) +
         row_floats(width(), 1);
}

template <typename T>
std::array<typename RowPairWarper<T>::SourceRow, 2> RowPairWarper<T>::source_rows(
    int y, std::span<float> scratch) const {
  constexpr int kMargin = kernels::kRowMarginPx;
  const std::size_t row = row_floats(width() + 2 * kMargin, 1);
  const auto source_row = [&](std::size_t side, ImageView<const T> image,
                              ImageView<const float> map_px) {
    float* const planes = scratch.data() + side * source_row_floats();
    float* const disparity_px = planes + row * static_cast<std::size_t>(image.channels());
    // The cameras are at 0 and 1 (3.5).
    return SourceRow{.pixels = image.row(y),
                     .map_px = map_px.row(y),
                     .camera_offset = view_x_ - static_cast<double>(side),
                     .planes = planes + kMargin,
                     .stride = static_cast<std::ptrdiff_t>(row),
                     .disparity_px = disparity_px + kMargin,
                     .column = disparity_px + row};
  };
  return {source_row(0, source_.left, source_.left_disparity),
          source_row(1, source_.right, source_.right_disparity)};
}

// Its place in the view; how its colours get there by interpolation.
template <typename T>
kernels::BicubicFetchRow RowPairWarper<T>::map_forward(const SourceRow& row,
                                                       float* warped_disparity_px) const {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  const bool forward = options_.warp == WarpColour::kForward;
  const int channels = source_.left.channels();
  kernels::load_pixel_planes(row.pixels, width(), channels, row.stride, row.planes);
  std::fill_n(row.disparity_px - kernels::kRowMarginPx, kernels::kRowMarginPx, kUnknown);
  std::copy_n(row.map_px, width(), row.disparity_px);
  std::fill_n(row.disparity_px + width(), kernels::kRowMarginPx, kUnknown);
  kernels::forward_warp_row({.disparity_px = row.disparity_px,
                             .width = width(),
                             .camera_offset = row.camera_offset,
                             .gradient_limit_px = limit},
                            warped_disparity_px, forward ? row.column : nullptr);
  return {.pixels = row.planes,
          .stride = row.stride,
          .source_disparity_px = row.disparity_px,
          .warped_disparity_px = warped_disparity_px,
          .width = width(),
          .channels = channels,
          .camera_offset = row.camera_offset,
          .gradient_limit_px = limit,
          .largest_value = kernels::kLargestValue<T>,
          .is_in_range = std::is_integral_v<T>};
}

template <typename T>
void RowPairWarper<T>::warp_one(const SourceRow& row, float* colours,
                                float* warped_disparity_px) const {
  const kernels::BicubicFetchRow fetched = map_forward(row, warped_disparity_px);
  if (options_.warp == WarpColour::kForward) {
    kernels::fetch_forward_row({.pixels = row.planes,
                                .stride = row.stride,
                                .source_column = row.column,
                                .width = width(),
                                .channels = fetched.channels},
                               colours);
  } else {
    kernels::fetch_bicubic_row(fetched, colours);
  }
}

template <typename T>
bool RowPairWarper<T>::blends() const {
  return source_.left_photograph.empty() && options_.warp == WarpColour::kOnePass;
}

template <typename T>
int RowPairWarper<T>::blend(int y, const kernels::BlendWeights& weights, std::span<float> scratch,
                            float* memory, const kernels::BlendedRow<T>& view) const {
  const WarpedPairLayout at(width(), source_.left.channels());
  const std::array<SourceRow, 2> rows = source_rows(y, scratch);
  kernels::FetchedPairRow fetched{.left = map_forward(rows[0], memory + at.left_nearness),
                                  .right = map_forward(rows[1], memory + at.right_nearness),
                                  .next = {}};
  if (y + 1 < height()) {
    const auto bytes = static_cast<int>(sizeof(T)) * source_.left.channels();
    fetched.next[0] = {source_.left.row(y + 1), bytes};
    fetched.next[1] = {source_.right.row(y + 1), bytes};
    fetched.next[2] = {source_.left_disparity.row(y + 1), sizeof(float)};
    fetched.next[3] = {source_.right_disparity.row(y + 1), sizeof(float)};
  }
  return kernels::blend_fetched_row(fetched, weights, view);
}

// The warp moves whole rows of the rectified image, so positions there are exact columns of row y.
template <typename T>
void RowPairWarper<T>::warp_from_photograph(const SurfaceColours<T>& from, int y,
                                            double camera_offset, std::span<float> scratch,
                                            float* colours, float* warped_disparity_px) const {
  float* const nearness = scratch.data() + position_floats(width());
  const kernels::SourcePositions positions = positions_in(scratch, width(), nearness);
  kernels::forward_warp_row({.disparity_px = from.disparity_px.row(y),
                             .width = width(),
                             .camera_offset = camera_offset,
                             .gradient_limit_px = from.gradient_limit_px},
                            warped_disparity_px, nullptr);
  kernels::SourceProjection back;
  back.parallax[0] = -camera_offset;
  kernels::source_positions_row(back,
                                {.nearness = warped_disparity_px,
                                 .count = width(),
                                 .line = y,
                                 .source_width = width(),
                                 .source_height = height()},
                                positions);
  from.fetch(positions, width(), colours);
}

template <typename T>
void RowPairWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  const WarpedPairLayout at(width(), source_.left.channels());
  if (source_.left_photograph.empty()) {
    const std::array<SourceRow, 2> rows = source_rows(y, scratch);
    warp_one(rows[0], memory + at.left_colours, memory + at.left_nearness);
    warp_one(rows[1], memory + at.right_colours, memory + at.right_nearness);
    return;
  }
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  warp_from_photograph({source_.left, source_.left_disparity, source_.left_photograph, limit}, y,
                       view_x_, scratch, memory + at.left_colours, memory + at.left_nearness);
  warp_from_photograph({source_.right, source_.right_disparity, source_.right_photograph, limit}, y,
                       view_x_ - 1, scratch, memory + at.right_colours, memory + at.right_nearness);
}

template class RowPairWarper<std::uint8_t>;
template class RowPairWarper<std::uint16_t>;
template class RowPairWarper<float>;

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
