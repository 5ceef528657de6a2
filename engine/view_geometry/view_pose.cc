#include "engine/view_geometry/view_pose.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/error.h"

namespace vantage {
namespace {

PosedCamera camera_between(const PosedCamera& from, const PosedCamera& to, double share) {
  PosedCamera camera = from;
  camera.matrix += share * (to.matrix - from.matrix);
  camera.rotation =
      Eigen::Quaterniond(from.rotation).slerp(share, Eigen::Quaterniond(to.rotation)).matrix();
  const Eigen::Vector3d centre = from.centre() + share * (to.centre() - from.centre());
  camera.translation = -camera.rotation * centre;
  return camera;
}

}  // namespace

std::string to_string(BaselinePosition position) {
  return position.y == 0 ? fmt::format("{}", position.x)
                         : fmt::format("{},{}", position.x, position.y);
}

void require_alike(const ViewPose& first, const ViewPose& second) {
  if (first.index() != second.index()) {
    throw UsageError(
        "view path has positions on the baseline and cameras, expected poses of one kind");
  }
  if (const auto* camera = std::get_if<PosedCamera>(&first)) {
    const auto& other = std::get<PosedCamera>(second);
    if ((camera->width_px == 0) != (other.width_px == 0)) {
      throw UsageError(
          "view path has cameras with and without a size, expected it for all or for none");
    }
    if (camera->width_px != other.width_px || camera->height_px != other.height_px) {
      throw UsageError(fmt::format("view path has cameras of {}×{} and {}×{}, expected one size",
                                   camera->width_px, camera->height_px, other.width_px,
                                   other.height_px));
    }
  }
}

ViewPose pose_between(const ViewPose& from, const ViewPose& to, double share) {
  require_alike(from, to);
  if (const auto* camera = std::get_if<PosedCamera>(&from)) {
    return camera_between(*camera, std::get<PosedCamera>(to), share);
  }
  const auto& first = std::get<BaselinePosition>(from);
  const auto& second = std::get<BaselinePosition>(to);
  return BaselinePosition{first.x + share * (second.x - first.x),
                          first.y + share * (second.y - first.y)};
}

ViewPose moved_right(const ViewPose& pose, double baselines, double baseline) {
  if (const auto* position = std::get_if<BaselinePosition>(&pose)) {
    return BaselinePosition{position->x + baselines, position->y};
  }
  PosedCamera camera = std::get<PosedCamera>(pose);
  camera.translation.x() -= baselines * baseline;
  return camera;
}

std::vector<BaselinePosition> orbit(double radius_baselines, int views) {
  std::vector<BaselinePosition> positions;
  positions.reserve(static_cast<std::size_t>(views));
  for (int i = 0; i < views; ++i) {
    const double angle = 2 * std::numbers::pi * i / views;
    positions.push_back(
        {0.5 + radius_baselines * std::cos(angle), -radius_baselines * std::sin(angle)});
  }
  return positions;
}

PosedCamera camera_looking_at(const RectifiedPair& pair, BaselinePosition position,
                              double disparity_px) {
  const double inverse_depth = disparity_px + pair.doffs_px;
  if (!(inverse_depth > 0) || !std::isfinite(inverse_depth)) {
    throw UsageError(fmt::format("disparity to look at is {}, expected more than {} px, infinity's",
                                 disparity_px, -pair.doffs_px));
  }
  const double depth = pair.left.matrix(0, 0) * pair.baseline / inverse_depth;
  const Eigen::Vector3d target(pair.baseline / 2, 0, depth);
  const Eigen::Vector3d centre(position.x * pair.baseline, position.y * pair.baseline, 0);
  const Eigen::Vector3d z = (target - centre).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  PosedCamera camera{
      .matrix = pair.left.matrix, .width_px = pair.width_px, .height_px = pair.height_px};
  camera.rotation.row(0) = x;
  camera.rotation.row(1) = z.cross(x);
  camera.rotation.row(2) = z;
  camera.translation = -camera.rotation * centre;
  return camera;
}

ViewPose placed(const ViewPose& pose, std::optional<double> look_at_px, const RectifiedPair* pair,
                int width_px, int height_px) {
  if (const auto* posed = std::get_if<PosedCamera>(&pose)) {
    PosedCamera camera = *posed;
    if (camera.width_px == 0) {
      camera.width_px = width_px;
      camera.height_px = height_px;
    }
    return camera;
  }
  if (!look_at_px) {
    return pose;
  }
  if (pair == nullptr) {
    throw UsageError(
        "a view that is turned towards a point needs calibrated cameras, expected a calibration");
  }
  return camera_looking_at(*pair, std::get<BaselinePosition>(pose), *look_at_px);
}

NewView new_view(const ViewPose& pose, const RectifiedPair* pair, int width_px, int height_px) {
  if (const auto* camera = std::get_if<PosedCamera>(&pose)) {
    if (pair == nullptr) {
      throw UsageError("a view with K, R and t needs calibrated cameras, expected a calibration");
    }
    return camera_view(*pair, *camera);
  }
  const auto& position = std::get<BaselinePosition>(pose);
  return baseline_view(position.x, position.y, width_px, height_px);
}

}  // namespace vantage
