#include "engine/evaluation/rms_differences.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/image/intensity_rows.h"
#include "engine/matching/search/match_inputs.h"

namespace vantage {
namespace {

Image<float> grey_levels(const Photograph& photograph) {
  Image<float> grey(photograph.width(), photograph.height());
  for (int y = 0; y < grey.height(); ++y) {
    intensity_row(photograph, y, grey.row(y));
  }
  return grey;
}

double rms_difference(const Image<float>& left, const Image<float>& right, int dx, int dy) {
  const int x_begin = std::max(0, dx);
  const int x_end = std::min(left.width(), left.width() + dx);
  const int y_begin = std::max(0, dy);
  const int y_end = std::min(left.height(), left.height() + dy);
  if (x_begin >= x_end || y_begin >= y_end) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0;
  for (int y = y_begin; y < y_end; ++y) {
    const float* const left_row = left.row(y);
    const float* const right_row = right.row(y - dy) - dx;
    for (int x = x_begin; x < x_end; ++x) {
      const double difference = double{left_row[x]} - double{right_row[x]};
      sum += difference * difference;
    }
  }
  return std::sqrt(sum / (static_cast<double>(x_end - x_begin) * (y_end - y_begin)));
}

}  // namespace

std::vector<double> rms_differences(const Photograph& left, const Photograph& right,
                                    DisparityRange displacements_x, DisparityRange displacements_y,
                                    Execution& execution) {
  require_equal_sizes(left, "left image", right, "right image");
  const Image<float> left_grey = grey_levels(left);
  const Image<float> right_grey = grey_levels(right);
  const int columns = displacements_x.count();
  std::vector<double> rms(static_cast<std::size_t>(columns) *
                          static_cast<std::size_t>(displacements_y.count()));
  execution.executor().parallel_for(static_cast<int>(rms.size()), [&](int index) {
    rms[static_cast<std::size_t>(index)] =
        rms_difference(left_grey, right_grey, displacements_x.min + index % columns,
                       displacements_y.min + index / columns);
  });
  return rms;
}

}  // namespace vantage
