#include "engine/view_geometry/nerf_transforms.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

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
  const Json matrix = frame.value("transform_matrix", Json());
  Eigen::Matrix4d pose;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const bool has_number = matrix.is_array() && matrix.size() >= 3 &&
                              (row == 3 || (matrix[row].is_array() && matrix[row].size() == 4 &&
                                            matrix[row][column].is_number()));
      if (!has_number) {
        throw Error(fmt::format("{} has no transform_matrix of 4x4 numbers", where));
      }
      pose(static_cast<int>(row), static_cast<int>(column)) =
          row == 3 ? 0 : matrix[row][column].get<double>();
    }
  }
  const auto rotation = nearest_rotation(pose.topLeftCorner<3, 3>());
  if (!rotation) {
    throw Error(fmt::format("{}: transform_matrix does not start with a rotation", where));
  }
  // Right, up and back become right, down and forward.
  const Eigen::Vector3d turn(1, -1, -1);
  return CameraPose::from_camera_to_world(*rotation * turn.asDiagonal(),
                                          pose.topRightCorner<3, 1>());
}

SizedCamera camera_of(const Json& document, const Json& frame, const std::string& where,
                      const std::function<ImageSize()>& size_of) {
  const auto number = [&](const char* key) { return number_of(document, frame, key); };
  SizedCamera sized;
  const auto width = number("w");
  const auto height = number("h");
  sized.size = width && height && *width >= 1 && *height >= 1 && *width < 1e6 && *height < 1e6
                   ? ImageSize{static_cast<int>(*width), static_cast<int>(*height)}
                   : size_of();
  const auto angle = number("camera_angle_x");
  const auto focal = number("fl_x");
  if (!focal && !angle) {
    throw Error(fmt::format("{} has no fl_x and no camera_angle_x", where));
  }
  const double fx = focal.value_or(sized.size.width_px / 2.0 / std::tan(angle.value_or(1) / 2));
  // Their pixel centres are at halves.
  sized.camera.matrix << fx, 0, number("cx").value_or(sized.size.width_px / 2.0) - 0.5, 0,
      number("fl_y").value_or(fx), number("cy").value_or(sized.size.height_px / 2.0) - 0.5, 0, 0, 1;
  const std::string model =
      document.contains("camera_model") && document["camera_model"].is_string()
          ? document["camera_model"].get<std::string>()
          : std::string();
  const bool is_fisheye = model == "OPENCV_FISHEYE";
  if (is_fisheye) {
    sized.camera.lens = LensKind::kFisheye;
  }
  for (const char* key : is_fisheye ? std::array{"k1", "k2", "k3", "k4", "k4"}
                                    : std::array{"k1", "k2", "p1", "p2", "k3"}) {
    sized.camera.distortion.push_back(number(key).value_or(0));
  }
  if (is_fisheye) {
    sized.camera.distortion.pop_back();
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
  const Json frames = document.value("frames", Json());
  if (!frames.is_array() || frames.empty()) {
    throw Error(fmt::format("{}: holds no frames, expected transforms.json of NeRF tools", file));
  }
  std::vector<PosedImage> images;
  for (const Json& frame : frames) {
    const std::string where = fmt::format("{}: frame {}", file, images.size());
    if (!frame.is_object() || !frame.value("file_path", Json()).is_string()) {
      throw Error(fmt::format("{} has no file_path", where));
    }
    const auto name = frame["file_path"].get<std::string>();
    images.push_back({.name = name, .camera = {}, .pose = pose_of(frame, where)});
    if (size_of) {
      images.back().camera = camera_of(document, frame, where, [&] { return size_of(name); });
    }
  }
  std::ranges::sort(images, {}, &PosedImage::name);
  return images;
}

}  // namespace vantage
