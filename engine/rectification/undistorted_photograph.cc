#include "engine/rectification/undistorted_photograph.h"

#include <Eigen/Dense>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "engine/image/remapped_row.h"

namespace vantage {

Photograph undistorted(Photograph source, const Camera& lens, Execution& execution) {
  if (lens.is_without_distortion()) {
    return source;
  }
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  const LensModel model(lens);
  const Eigen::Matrix3d ray_of = lens.matrix.inverse();
  return std::visit(
      [&]<typename T>(const Image<T>& from) {
        const int width = from.width();
        Image<T> to(width, from.height(), from.channels());
        execution.for_each_band(from.height(), [&](int first_row, int end_row) {
          std::vector<float> x_px(static_cast<std::size_t>(width));
          std::vector<float> y_px(static_cast<std::size_t>(width));
          for (int y = first_row; y < end_row; ++y) {
            for (int x = 0; x < width; ++x) {
              const Eigen::Vector3d ray = ray_of * Eigen::Vector3d(x, y, 1);
              const auto at = model.position_of(ray.hnormalized());
              const auto column = static_cast<std::size_t>(x);
              x_px[column] = at ? static_cast<float>(at->x()) : kNothing;
              y_px[column] = at ? static_cast<float>(at->y()) : kNothing;
            }
            remap_row(from, x_px.data(), y_px.data(), y, to);
          }
        });
        Photograph result;
        result.pixels = std::move(to);
        return result;
      },
      source.pixels);
}

}  // namespace vantage
