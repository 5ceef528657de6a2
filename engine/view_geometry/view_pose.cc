#include "engine/view_geometry/view_pose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <variant>

#include "engine/error.h"
#include "engine/quoted_text.h"

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

template <typename T>
bool read_number(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
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

ViewPose ViewPath::at(int frame) const {
  const auto next = std::ranges::upper_bound(keys, frame, {}, &Key::frame);
  if (next == keys.begin()) {
    return keys.front().pose;
  }
  const Key& before = *std::prev(next);
  if (next == keys.end() || before.frame == frame) {
    return before.pose;
  }
  return pose_between(before.pose, next->pose,
                      static_cast<double>(frame - before.frame) / (next->frame - before.frame));
}

void ViewPath::validate() const {
  if (keys.empty()) {
    throw UsageError("view path is empty, expected at least one pose");
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].frame < 0 || (i > 0 && keys[i].frame <= keys[i - 1].frame)) {
      throw UsageError(fmt::format(
          "view path has frame {} as key {}, expected frames from 0 that grow from key to key",
          keys[i].frame, i + 1));
    }
    require_alike(keys.front().pose, keys[i].pose);
  }
}

ViewPath parse_view_path(std::string_view text) {
  ViewPath path;
  bool may_have_y = false;  // the XS of the last key was just parsed
  for (std::string_view rest = text;;) {
    const std::size_t end = rest.find(',');
    const std::string_view part = rest.substr(0, end);
    const std::size_t equals = part.find('=');
    bool is_read = false;
    if (equals != std::string_view::npos) {
      int frame = 0;
      BaselinePosition position;
      is_read = read_number(part.substr(0, equals), frame) &&
                read_number(part.substr(equals + 1), position.x);
      path.keys.push_back({frame, position});
      may_have_y = true;
    } else if (may_have_y) {
      is_read = read_number(part, std::get<BaselinePosition>(path.keys.back().pose).y);
      may_have_y = false;
    }
    if (!is_read) {
      throw UsageError(
          fmt::format("is '{}', expected keys FRAME=XS or FRAME=XS,YS like 0=0,48=1,96=0 (at '{}')",
                      quotable(text), quotable(part)));
    }
    if (end == std::string_view::npos) {
      return path;
    }
    rest.remove_prefix(end + 1);
  }
}

std::string to_string(const ViewPath& path) {
  std::vector<std::string> keys;
  for (const ViewPath::Key& key : path.keys) {
    keys.push_back(
        fmt::format("{}={}", key.frame, to_string(std::get<BaselinePosition>(key.pose))));
  }
  return fmt::format("{}", fmt::join(keys, ","));
}

}  // namespace vantage
