#include "engine/rectification/rectifier.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/image/remapped_row.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

/// Deviation up to which a patch counts as bilinear; small against half a pixel, which changes the
/// nearest pixel.
constexpr double kLargestBend = 0.03;  // px

}  // namespace

Rectifier::Rectifier(const StereoCalibration& calibration, int width_px, int height_px,
                     const RectificationOptions& options)
    : photograph_size_{width_px, height_px},
      pair_(rectified_pair(calibration, width_px, height_px, options)),
      needs_rectification_(!calibration.is_rectified),
      views_{make_view(calibration.for_images(width_px, height_px).left, Side::kLeft),
             make_view(calibration.for_images(width_px, height_px).right, Side::kRight)} {}

Rectifier::View Rectifier::make_view(const Camera& camera, Side side) const {
  const RectifiedCamera& rectified = pair_.camera(side);
  View view{.lens = LensModel(camera),
            .ray_from_pixel = rectified.rotation.transpose() * rectified.matrix.inverse(),
            .x_px = {},
            .y_px = {}};
  if (!needs_rectification_) {
    return view;
  }
  constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  view.x_px.resize(pair_.width_px, pair_.height_px);
  view.y_px.resize(pair_.width_px, pair_.height_px);
  for (int y = 0; y < pair_.height_px; ++y) {
    scheduler::check_interruption();
    for (int x = 0; x < pair_.width_px; ++x) {
      const auto position = source_position(view, {x, y});
      view.x_px.at(x, y) = position ? static_cast<float>(position->x()) : kUnseen;
      view.y_px.at(x, y) = position ? static_cast<float>(position->y()) : kUnseen;
    }
  }
  return view;
}

std::optional<Eigen::Vector2d> Rectifier::source_position(const View& view,
                                                          const Eigen::Vector2d& rectified_px) {
  const Eigen::Vector3d ray = view.ray_from_pixel * rectified_px.homogeneous();
  return ray.z() > 0 ? view.lens.position_of(ray.hnormalized()) : std::nullopt;
}

std::optional<Eigen::Vector2d> Rectifier::source_position(
    Side side, const Eigen::Vector2d& rectified_px) const {
  return needs_rectification_ ? source_position(view(side), rectified_px)
                              : std::optional(rectified_px);
}

std::optional<Eigen::Vector2d> Rectifier::rectified_position(
    Side side, const Eigen::Vector2d& source_px) const {
  if (!needs_rectification_) {
    return source_px;
  }
  const auto ray = view(side).lens.ray_of(source_px);
  if (!ray) {
    return std::nullopt;
  }
  const RectifiedCamera& camera = pair_.camera(side);
  const Eigen::Vector3d point = camera.matrix * camera.rotation * ray->homogeneous();
  return point.z() > 0 ? std::optional<Eigen::Vector2d>(point.hnormalized()) : std::nullopt;
}

/// Of the rectified image; pixels of the source are those nearest to positions.
Mask Rectifier::left_out_of(const Photograph& source, Side side, Execution& execution) const {
  if (!needs_rectification_) {
    return source.left_out.copy();
  }
  const PhotographPositions positions = source_positions(side);
  Mask left_out(pair_.width_px, pair_.height_px);
  execution.for_each_row(left_out.height(), [&](int y) {
    for (int x = 0; x < left_out.width(); ++x) {
      const float column = std::floor(positions.x_px.at(x, y) + 0.5F);
      const float row = std::floor(positions.y_px.at(x, y) + 0.5F);
      const bool is_seen = column >= 0 && column < static_cast<float>(source.width()) && row >= 0 &&
                           row < static_cast<float>(source.height());
      left_out.at(x, y) = !is_seen ? 255
                          : source.left_out.empty()
                              ? 0
                              : source.left_out.at(static_cast<int>(column), static_cast<int>(row));
    }
  });
  return left_out;
}

void Rectifier::apply(const Photograph& source, Side side, Photograph& result,
                      Execution& execution) const {
  const int width = pair_.width_px;
  const int height = pair_.height_px;
  if (source.width() != photograph_size_.width_px ||
      source.height() != photograph_size_.height_px) {
    throw Error(fmt::format("the image to rectify is {}x{}, expected {}x{}", source.width(),
                            source.height(), photograph_size_.width_px,
                            photograph_size_.height_px));
  }
  result.origin = source.origin;
  std::visit(
      [&]<typename T>(const Image<T>& from) {
        Image<T>& to = pixels_of<T>(result);
        to.resize(width, height, from.channels());
        execution.for_each_row(height, [&](int y) {
          if (!needs_rectification_) {
            std::copy_n(from.row(y), width * from.channels(), to.row(y));
            return;
          }
          remap_row(from, view(side).x_px.row(y), view(side).y_px.row(y), y, to);
        });
      },
      source.pixels);
  result.left_out = {};
  leave_out(result, left_out_of(source, side, execution));
}

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
        return Photograph{std::move(to), source.origin};
      },
      source.pixels);
}

RectifiedPositions::RectifiedPositions(const Rectifier& rectifier, Side side)
    : rectifier_(rectifier),
      side_(side),
      patches_(static_cast<std::size_t>((rectifier.pair().width_px - 1) / kPatchPx + 1)) {}

Eigen::Vector2d RectifiedPositions::exact(double x, double y) const {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  return rectifier_.rectified_position(side_, {x, y}).value_or(Eigen::Vector2d::Constant(kNowhere));
}

void RectifiedPositions::make_patches() {
  const double top = kPatchPx * row_;
  Eigen::Vector2d upper_right = exact(0, top);
  Eigen::Vector2d lower_right = exact(0, top + kPatchPx);
  double left = 0;
  for (Patch& patch : patches_) {
    patch.corners[0] = upper_right;
    patch.corners[2] = lower_right;
    upper_right = exact(left + kPatchPx, top);
    lower_right = exact(left + kPatchPx, top + kPatchPx);
    patch.corners[1] = upper_right;
    patch.corners[3] = lower_right;
    const Eigen::Vector2d centre = exact(left + kPatchPx / 2.0, top + kPatchPx / 2.0);
    patch.is_smooth = (patch.position(0.5, 0.5) - centre).norm() <= kLargestBend;  // false for NaN
    left += kPatchPx;
  }
}

}  // namespace vantage
