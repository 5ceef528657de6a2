#include "engine/view_geometry/nerf_transforms.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "engine/error.h"
#include "engine/io/files/json_text.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// A number of a frame, or of all.
std::optional<double> number_of(const Json& document, const Json& frame, const char* key) {
  for (const Json* object : {&frame, &document}) {
    if (object->contains(key) && (*object)[key].is_number()) {
      return (*object)[key].get<double>();
    }
  }
  return std::nullopt;
}

CameraPose pose_of(const Json& frame, const std::string& where) {
  const auto rows = frame.at("transform_matrix").get<std::vector<std::vector<double>>>();
  Eigen::Matrix<double, 3, 4> pose;
  for (std::size_t i = 0; i < 12; ++i) {
    pose(static_cast<int>(i / 4), static_cast<int>(i % 4)) = rows.at(i / 4).at(i % 4);
  }
  const auto rotation = nearest_rotation(pose.leftCols<3>());
  if (!rotation) {
    throw Error(fmt::format("{}: transform_matrix does not start with a rotation", where));
  }
  // Right, up and back become right, down and forward.
  return CameraPose::from_camera_to_world(*rotation * Eigen::Vector3d(1, -1, -1).asDiagonal(),
                                          pose.col(3));
}

SizedCamera camera_of(const Json& document, const Json& frame, const std::string& where,
                      const std::function<ImageSize()>& size_of) {
  const auto number = [&](const char* key) { return number_of(document, frame, key); };
  SizedCamera sized;
  const double width = number("w").value_or(0);
  const double height = number("h").value_or(0);
  sized.size = width >= 1 && height >= 1 && width < 1e6 && height < 1e6
                   ? ImageSize{static_cast<int>(width), static_cast<int>(height)}
                   : size_of();
  const auto angle = number("camera_angle_x");
  const auto focal = number("fl_x");
  if (!focal && !angle) {
    throw Error(fmt::format("{} has no fl_x and no camera_angle_x", where));
  }
  const double fx = focal.value_or(sized.size.width_px / 2.0 / std::tan(angle.value_or(1) / 2));
  const double fy = number("fl_y").value_or(fx);
  // Their pixel centres are at halves.
  const double cx = number("cx").value_or(sized.size.width_px / 2.0) - 0.5;
  const double cy = number("cy").value_or(sized.size.height_px / 2.0) - 0.5;
  sized.camera.matrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  const bool is_fisheye = document.value("camera_model", Json()) == "OPENCV_FISHEYE";
  sized.camera.lens = is_fisheye ? LensKind::kFisheye : LensKind::kStandard;
  const auto keys =
      is_fisheye ? std::vector{"k1", "k2", "k3", "k4"} : std::vector{"k1", "k2", "p1", "p2", "k3"};
  for (const char* key : keys) {
    sized.camera.distortion.push_back(number(key).value_or(0));
  }
  sized.camera.validate(where);
  return sized;
}

}  // namespace

bool is_nerf_transforms(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && text[first] == '{';
}

std::vector<PosedImage> parse_nerf_transforms(
    std::string_view text, const std::string& file,
    const std::function<ImageSize(const std::string& name)>& size_of) {
  const Json document = parse_json(text, file);
  std::vector<PosedImage> images;
  try {
    for (const Json& frame : document.at("frames")) {
      const std::string where = fmt::format("{}: frame {}", file, images.size());
      const auto name = frame.at("file_path").get<std::string>();
      images.push_back({.name = name, .camera = {}, .pose = pose_of(frame, where)});
      if (size_of) {
        images.back().camera = camera_of(document, frame, where, [&] { return size_of(name); });
      }
    }
  } catch (const std::logic_error&) {  // out of range
    images.clear();
  } catch (const nlohmann::json::exception&) {
    images.clear();
  }
  if (images.empty()) {
    throw Error(
        fmt::format("{}: expected transforms.json of NeRF tools: frames, each with file_path and "
                    "transform_matrix (4x4)",
                    file));
  }
  std::ranges::sort(images, {}, &PosedImage::name);
  return images;
}

}  // namespace vantage
