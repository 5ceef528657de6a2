#include "engine/scene_graph/posed_pair.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <variant>

#include "engine/scene_graph/interpolated_disparity.h"
#include "kernels/bicubic_remap/bicubic_remap.h"

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kRectifiedTolerance = 1e-12;

/// Whether rows of the photographs correspond as they are.
bool is_rectified(const StereoCalibration& calibration) {
  Eigen::Matrix3d difference = calibration.left.matrix - calibration.right.matrix;
  difference(0, 2) = 0;
  const Eigen::Vector3d direction = calibration.translation.normalized();
  return difference.isZero(0) && calibration.left.is_without_distortion() &&
         calibration.right.is_without_distortion() &&
         calibration.left.matrix(0, 2) == calibration.right.matrix(0, 2) &&
         calibration.rotation.isIdentity(kRectifiedTolerance) &&
         (direction + Eigen::Vector3d::UnitX()).norm() <= kRectifiedTolerance;
}

StereoCalibration with_rectified_ones_marked(StereoCalibration calibration) {
  calibration.is_rectified = is_rectified(calibration);
  return calibration;
}

/// Halfway between what both cameras see and what either sees: views need the outer parts, too, and
/// photographs are not black where their own pixels are brought back.
constexpr RectificationOptions kAnyDirection = {.kept_outline = 0.5, .any_direction = true};

}  // namespace

StereoCalibration calibration_of(const SceneCamera& first, const SceneCamera& second, int width_px,
                                 int height_px) {
  const CameraPose pose = relative_pose(first.pose, second.pose);
  return {.left = first.lens,
          .right = second.lens,
          .rotation = pose.rotation,
          .translation = pose.translation,
          .image_size = ImageSize{width_px, height_px},
          .format = "posed cameras"};
}

PosedPair::PosedPair(const StereoCalibration& calibration, int width_px, int height_px,
                     Execution& execution)
    : calibration_(with_rectified_ones_marked(calibration)),
      width_px_(width_px),
      height_px_(height_px),
      rectifier_(calibration_, width_px, height_px, kAnyDirection),
      execution_(&execution) {}

std::array<Photograph, 2> PosedPair::rectified(const std::array<Photograph, 2>& photographs) const {
  std::array<Photograph, 2> result;
  rectifier_.apply(photographs[0], Side::kLeft, result[0], *execution_);
  rectifier_.apply(photographs[1], Side::kRight, result[1], *execution_);
  return result;
}

MatchedMap PosedPair::on_photograph(Side side, const MatchedMap& map, double scale_px) const {
  const RectifiedPair& pair = rectifier_.pair();
  const RectifiedCamera& camera = pair.camera(side);
  const Camera& lens = side == Side::kLeft ? calibration_.left : calibration_.right;
  // Depth in the photograph's camera = depth in the rectified one / Z of the turned ray (X, Y, 1).
  const Eigen::Matrix3d ray_of = camera.rotation * lens.matrix.inverse();
  const double scale = scale_px / focal_length_px();
  MatchedMap result;
  result.disparity_px.resize(width_px_, height_px_);
  result.unmatched.resize(width_px_, height_px_);
  execution_->for_each_band(height_px_, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      for (int x = 0; x < width_px_; ++x) {
        float& disparity_px = result.disparity_px.at(x, y);
        std::uint8_t& unmatched = result.unmatched.at(x, y);
        disparity_px = kUnknown;
        unmatched = 255;
        const Eigen::Vector3d ray = ray_of * Eigen::Vector3d(x, y, 1);
        const Eigen::Vector2d at = (camera.matrix * ray).hnormalized();
        if (!(ray.z() > 0 && at.x() >= 0 && at.x() <= pair.width_px - 1 && at.y() >= 0 &&
              at.y() <= pair.height_px - 1)) {
          continue;
        }
        const float d = interpolated_disparity(map.disparity_px.view(), at.x(), at.y());
        if (std::isfinite(d)) {
          disparity_px = static_cast<float>(std::max(double{d}, 0.0) * ray.z() * scale);
          unmatched =
              map.unmatched.at(static_cast<int>(at.x() + 0.5), static_cast<int>(at.y() + 0.5));
        }
      }
    }
  });
  return result;
}

Photograph undistorted(Photograph source, const Camera& lens, Execution& execution) {
  if (lens.is_without_distortion()) {
    return source;
  }
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
              x_px[column] = at ? static_cast<float>(at->x()) : kUnknown;
              y_px[column] = at ? static_cast<float>(at->y()) : kUnknown;
            }
            kernels::remap_bicubic_row(
                kernels::RemapRow<T>{.pixels = from.row(0),
                                     .stride = static_cast<std::ptrdiff_t>(from.view().stride()),
                                     .width = width,
                                     .height = from.height(),
                                     .channels = from.channels(),
                                     .x_px = x_px.data(),
                                     .y_px = y_px.data(),
                                     .count = width},
                to.row(y));
          }
        });
        Photograph result;
        result.pixels = std::move(to);
        return result;
      },
      source.pixels);
}

}  // namespace vantage
