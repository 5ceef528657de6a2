#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/view_projection/view_projection.h"

namespace vantage::kernels {
namespace {

std::int32_t whole(double target) {
  return static_cast<std::int32_t>(std::clamp(target, double{-kFarTargetPx}, double{kFarTargetPx}));
}

}  // namespace

void project_row_ref(const ViewProjection& view, const ProjectionSource& source,
                     const ProjectedRow& row) {
  for (int i = 0; i < source.count; ++i) {
    row.disparity_px[i] = std::numeric_limits<float>::quiet_NaN();
    row.nearness[i] = -std::numeric_limits<float>::infinity();
    row.column[i] = 0;
    row.line[i] = 0;
    const float d = source.disparity_px[i];
    if (!std::isfinite(d)) {
      continue;
    }
    const int x = source.first_column + i;
    const ExactTarget target = exact_target(view, x, source.line, d);
    if (!(target.depth_ratio > kMinDepthRatio)) {
      continue;
    }
    const double distance = double{d} - view.infinity_disparity_px;
    const double nearness = view.is_translation ? distance : distance * (1 / target.depth_ratio);
    if (!(std::abs(nearness) <= std::numeric_limits<float>::max())) {
      continue;
    }
    row.disparity_px[i] = d;
    row.nearness[i] = static_cast<float>(nearness);
    if (view.is_translation) {
      row.column[i] = whole(x + std::floor(0.5 + view.parallax[0] * d));
      row.line[i] = whole(source.line + std::floor(0.5 + view.parallax[1] * d));
    } else {
      row.column[i] = whole(std::floor(target.u + 0.5));
      row.line[i] = whole(std::floor(target.v + 0.5));
    }
  }
}

}  // namespace vantage::kernels
