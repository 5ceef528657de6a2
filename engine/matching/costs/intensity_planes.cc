#include "engine/matching/costs/intensity_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/image/intensity_rows.h"
#include "kernels/column_ssd/column_ssd.h"

namespace vantage {
namespace {

bool is_8_bit_grey(const Photograph& photograph) {
  return photograph.channels() == 1 &&
         std::holds_alternative<Image<std::uint8_t>>(photograph.pixels);
}

struct Bounds {
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
};

/// Writes the intensities of the whole photograph to `plane`; returns their bounds.
Bounds fill_grey(const Photograph& photograph, Execution& execution, IntensityPlane<float>& plane) {
  std::vector<Bounds> of_row(static_cast<std::size_t>(photograph.height()));
  execution.for_each_band(photograph.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      float* grey = plane.row(y);
      intensity_row(photograph, y, grey);
      const auto [low, high] = std::minmax_element(grey, grey + photograph.width());
      of_row[static_cast<std::size_t>(y)] = {*low, *high};
    }
  });
  Bounds bounds;
  for (const Bounds& row : of_row) {
    bounds.low = std::min(bounds.low, row.low);
    bounds.high = std::max(bounds.high, row.high);
  }
  return bounds;
}

/// The power of two by which intensities with these bounds are multiplied.
float cost_scale(const Bounds& bounds, int window_samples) {
  const double span = static_cast<double>(bounds.high) - bounds.low;
  if (!(span > 0)) {
    return 1;
  }
  // Each cost may round up by ½. The margin covers rounding of the float products and still allows
  // the scale 8 for a span of 255 grey levels.
  const double max_cost = 0.995 * std::min<double>(kernels::kFloatSquareLimit,
                                                   std::numeric_limits<std::int32_t>::max() /
                                                           static_cast<double>(window_samples) -
                                                       1);
  return static_cast<float>(std::exp2(std::floor(std::log2(std::sqrt(max_cost) / span))));
}

/// Fills the margins of one row of the left plane and mirrors the row of the right image. The
/// pixels must be filled.
template <typename Pixel>
void finish_row(IntensityPlanes<Pixel>& planes, const Pixel* right, int width, int y,
                PlanesNeeded needed) {
  planes.left.fill_margins(y);
  if (needed.left_reference) {
    std::reverse_copy(right, right + width, planes.right_mirrored.row(y));
    planes.right_mirrored.fill_margins(y);
  }
}

template <typename Pixel>
void resize_planes(IntensityPlanes<Pixel>& planes, int height,
                   const kernels::CandidateGeometry& geometry, PlanesNeeded needed) {
  // Lane i of column x is read at x + disparity_min + i in both the plain and the mirrored plane.
  const int before = std::max(0, -geometry.disparity_min);
  // Kernels read whole vectors: up to a lane multiple past the last pixel used.
  const int after = std::max(0, geometry.disparity_min + geometry.lanes()) + kernels::kLaneMultiple;
  planes.left.resize(geometry.width, height, before, after);
  planes.right.resize(geometry.width, height, 0, kernels::kLaneMultiple);
  if (needed.left_reference) {
    planes.right_mirrored.resize(geometry.width, height, before, after);
  }
}

void scale_row(float scale, int width, float* row) {
  for (int x = 0; x < width; ++x) {
    row[x] *= scale;
  }
}

}  // namespace

template <typename Pixel>
void IntensityPlane<Pixel>::resize(int width, int height, int margin_begin, int margin_end) {
  width_ = width;
  margin_begin_ = margin_begin;
  margin_end_ = margin_end;
  pixels_.resize(margin_begin + width + margin_end, height);
}

template <typename Pixel>
void IntensityPlane<Pixel>::fill_margins(int y) {
  Pixel* first = row(y);
  std::fill(first - margin_begin_, first, first[0]);
  std::fill(first + width_, first + width_ + margin_end_, first[width_ - 1]);
}

template class IntensityPlane<std::uint8_t>;
template class IntensityPlane<std::uint16_t>;
template class IntensityPlane<std::uint32_t>;
template class IntensityPlane<float>;

void PreparedPair::prepare(const Photograph& left, const Photograph& right,
                           const kernels::CandidateGeometry& geometry, int window_samples,
                           PlanesNeeded needed, Execution& execution) {
  const int width = left.width();
  const int height = left.height();
  is_8_bit = is_8_bit_grey(left) && is_8_bit_grey(right);
  if (is_8_bit) {
    IntensityPlanes<std::uint8_t>& planes = grey_8;
    resize_planes(planes, height, geometry, needed);
    const auto& left_pixels = std::get<Image<std::uint8_t>>(left.pixels);
    const auto& right_pixels = std::get<Image<std::uint8_t>>(right.pixels);
    execution.for_each_band(height, [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        std::copy_n(left_pixels.row(y), width, planes.left.row(y));
        if (needed.right_reference) {
          std::copy_n(right_pixels.row(y), width, planes.right.row(y));
        }
        finish_row(planes, right_pixels.row(y), width, y, needed);
      }
    });
    return;
  }
  IntensityPlanes<float>& planes = grey_float;
  resize_planes(planes, height, geometry, needed);
  const Bounds of_left = fill_grey(left, execution, planes.left);
  const Bounds of_right = fill_grey(right, execution, planes.right);
  const float scale = cost_scale(
      {std::min(of_left.low, of_right.low), std::max(of_left.high, of_right.high)}, window_samples);
  cost_unit = 1 / (scale * scale);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      scale_row(scale, width, planes.left.row(y));
      scale_row(scale, width, planes.right.row(y));
      finish_row(planes, planes.right.row(y), width, y, needed);
    }
  });
}

}  // namespace vantage
