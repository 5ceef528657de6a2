#pragma once

#include "kernels/source_position/source_position.h"
#include "kernels/surface_splat/surface_splat.h"
#include "kernels/view_projection/view_projection.h"
#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels {

inline ViewProjection translation(double x, double y) {
  ViewProjection view;
  view.parallax[0] = -x;
  view.parallax[1] = -y;
  return view;
}

/// A camera of its own focal length, turned about its axes, seen from one of focal length `focal`,
/// both with principal point (cx, cy); centre in baselines.
inline ViewProjection camera(double focal, double zoom, double roll, double yaw, double pitch,
                             const double (&centre)[3], double cx, double cy, double infinity) {
  const double cr = std::cos(roll), sr = std::sin(roll);
  const double cw = std::cos(yaw), sw = std::sin(yaw);
  const double cp = std::cos(pitch), sp = std::sin(pitch);
  const double about_z[3][3] = {{cr, -sr, 0}, {sr, cr, 0}, {0, 0, 1}};
  const double about_y[3][3] = {{cw, 0, sw}, {0, 1, 0}, {-sw, 0, cw}};
  const double about_x[3][3] = {{1, 0, 0}, {0, cp, -sp}, {0, sp, cp}};
  const double to_rays[3][3] = {
      {1 / focal, 0, -cx / focal}, {0, 1 / focal, -cy / focal}, {0, 0, 1}};
  const double to_pixels[3][3] = {{zoom * focal, 0, cx}, {0, zoom * focal, cy}, {0, 0, 1}};
  const auto product = [](const double(&a)[3][3], const double(&b)[3][3], double(&c)[3][3]) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
      }
    }
  };
  double step[3][3];
  double turned[3][3];
  double pixels_turned[3][3];
  double far[3][3];
  product(about_z, about_y, step);
  product(step, about_x, turned);
  product(to_pixels, turned, pixels_turned);
  product(pixels_turned, to_rays, far);
  ViewProjection view;
  view.is_translation = false;
  view.infinity_disparity_px = infinity;
  for (int i = 0; i < 3; ++i) {
    view.parallax[i] = 0;
    for (int j = 0; j < 3; ++j) {
      view.parallax[i] -= pixels_turned[i][j] * centre[j] / focal;
    }
    for (int j = 0; j < 3; ++j) {
      view.homography[3 * i + j] = far[i][j] - (j == 2 ? infinity * view.parallax[i] : 0.0);
    }
  }
  return view;
}

/// Views on and off the baseline, turned, zoomed, moved forward; of images about 40 pixels wide.
inline std::vector<ViewProjection> projection_cases() {
  return {translation(0, 0), translation(0.3137, 0), translation(-1.713, 0),
          translation(0.4771, 0.6133), translation(-0.5417, -2.2137), translation(0, 1.1371),
          camera(50, 1.0, 0.2, 0.1, -0.05, {0.5, 0.3, 0}, 19.3, 13.7, 0),
          camera(50, 1.7, -0.9, 0.05, 0.1, {-0.4, 0.1, 0.2}, 19.3, 13.7, -1.5),
          camera(50, 0.5, 1.6, -0.1, 0.2, {0.3, -0.7, -0.5}, 19.3, 13.7, 2.25),
          camera(50, 3.0, 3.0, 0, 0, {0.2, 0.2, 0.3}, 19.3, 13.7, 0),
          // Stands among the surfaces: some are behind it.
          camera(50, 0.7, 0.1, 0.9, 0.4, {0.2, 0, 4.0}, 19.3, 13.7, 0.5)};
}

/// A map of smooth pieces with jumps and unknown stretches along both axes.
inline std::vector<float> random_map(std::mt19937& random, int width, int height) {
  std::vector<float> map(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const std::vector<float> offsets = random_disparities(random, height, 0, 12);
  std::vector<float> row;
  for (int y = 0; y < height; ++y) {
    const bool own_row = random() % 4 == 0;
    if (own_row || row.empty()) {
      row = random_disparities(random, width, 0, 12);
    }
    for (int x = 0; x < width; ++x) {
      const float offset = offsets[y];
      map[y * width + x] = row[x] + (std::isnan(offset) ? 0.0F : 0.25F * offset);
    }
  }
  return map;
}

/// A projected row with the padding that splat_rows() may read.
struct ProjectedValues {
  std::vector<float> disparity_px, nearness;
  std::vector<std::int32_t> column, line;

  explicit ProjectedValues(int count)
      : disparity_px(static_cast<std::size_t>(count + 1 + kSplatPadding),
                     std::numeric_limits<float>::quiet_NaN()),
        nearness(disparity_px.size(), -std::numeric_limits<float>::infinity()),
        column(disparity_px.size()),
        line(disparity_px.size()) {}
  [[nodiscard]] ProjectedRow row() {
    return {disparity_px.data(), nearness.data(), column.data(), line.data()};
  }
};

}  // namespace vantage::kernels
