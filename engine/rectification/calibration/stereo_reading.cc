#include "engine/rectification/calibration/stereo_reading.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/rectification/calibration/projection_files.h"
#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

using Value = CalibrationValue;
using Found = CalibrationNames::Found;

/// Two cameras, and what their files say of both.
struct StereoReading {
  std::array<CameraReading, 2> cameras;
  std::optional<CameraPose> relative;  ///< of the second camera, in the first one's frame
  std::optional<double> metres_per_unit;
  std::string format;
  bool may_be_swapped = false;  ///< nothing says that the first one is the left one
};

Eigen::Matrix3d stated_rotation(const Found& found) {
  if (found.entry->values.size() == 3) {
    const std::vector<double>& vector = values_of(found, 3, 1);
    return rotation_by({vector[0], vector[1], vector[2]});
  }
  const Eigen::Matrix3d rotation = matrix_of(found);
  return nearest_rotation(rotation).value_or(rotation);
}

/// By the rectifying rotations of both cameras: their rectified frames differ by `translation`.
CameraPose pose_between(const CameraReading& first, const CameraReading& second,
                        const Eigen::Vector3d& translation) {
  const Eigen::Matrix3d from_rectified =
      second.rectification.value_or(Eigen::Matrix3d::Identity()).transpose();
  return {.rotation = from_rectified * first.rectification.value_or(Eigen::Matrix3d::Identity()),
          .translation = from_rectified * translation};
}

/// What the cameras' own entries say of the second one's place, in metres.
bool find_relative_pose(StereoReading& pair) {
  const auto& [first, second] = pair.cameras;
  if (second.from_previous) {
    pair.relative = second.from_previous;
    pair.format = "Kalibr";
  } else if (first.from_body && second.from_body) {
    pair.relative = relative_pose(*first.from_body, *second.from_body);
    pair.format = "cameras on a body";
  } else if (first.projection && second.projection) {
    pair.relative = pose_between(
        first, second, from_projections(*first.projection, *second.projection).translation);
    pair.format = "ROS";
  }
  return pair.relative.has_value();
}

void find_relative_pose(const CalibrationNames& names, StereoReading& pair) {
  const Found translation = names.find(Value::kTranslation);
  const Found rotation = names.find(Value::kRotation);
  const Found from_right = names.find(Value::kFromRight);
  const Found focal_baseline = names.find(Value::kFocalBaseline);
  const Found baseline = names.find(Value::kBaseline);
  pair.may_be_swapped = names.counts_from_0();
  if (translation.entry != nullptr && rotation.entry != nullptr) {
    pair.relative = {
        .rotation = stated_rotation(rotation),
        .translation = Eigen::Map<const Eigen::Vector3d>(values_of(translation, 3, 1).data())};
    pair.format = "OpenCV";
    pair.may_be_swapped = false;
    return;
  }
  pair.metres_per_unit = 1;
  if (from_right.entry != nullptr) {
    pair.relative = relative_pose(transform_of(from_right), CameraPose());
    pair.format = "ORB-SLAM";
  } else if (!find_relative_pose(pair) &&
             (focal_baseline.entry != nullptr || baseline.entry != nullptr)) {
    const Found focal = names.find(Value::kFx);
    const double focal_px = focal.entry != nullptr   ? number_of(focal)
                            : pair.cameras[0].matrix ? (*pair.cameras[0].matrix)(0, 0)
                                                     : 0;
    const double length = focal_baseline.entry != nullptr ? number_of(focal_baseline) / focal_px
                                                          : number_of(baseline);
    pair.relative = pose_between(pair.cameras[0], pair.cameras[1], {-length, 0, 0});
    pair.format = "ORB-SLAM";
  }
  const bool is_in_metres = focal_baseline.entry != nullptr || from_right.entry != nullptr ||
                            pair.cameras[1].from_previous || pair.cameras[1].from_body ||
                            baseline.name == "Stereo.b";
  if (!is_in_metres) {  // P1 and P2 of OpenCV, or a baseline
    pair.metres_per_unit.reset();
    pair.format = "OpenCV";
  }
}

/// The right camera is to the right: of files that number their cameras, this tells which it is.
void put_in_order(StereoReading& pair, const std::string& file, std::vector<Remark>& remarks) {
  const Eigen::Vector3d& t = pair.relative->translation;
  if (pair.may_be_swapped && t.x() > std::abs(t.y())) {
    std::swap(pair.cameras[0], pair.cameras[1]);
    pair.relative = relative_pose(*pair.relative, CameraPose());
    remarks.push_back({.kind = Remark::Kind::kNote,
                       .subject = "calibration",
                       .text = fmt::format("{}: its second camera is to the left of the first one, "
                                           "and is that of the left image",
                                           file)});
  }
}

bool is_pair_of_rectified(const StereoCalibration& calibration) {
  Eigen::Matrix3d difference = calibration.left.matrix - calibration.right.matrix;
  difference(0, 2) = 0;
  return difference.isZero(0) && calibration.left.is_without_distortion() &&
         calibration.right.is_without_distortion() &&
         calibration.rotation == Eigen::Matrix3d::Identity() && calibration.translation.x() < 0 &&
         calibration.translation.y() == 0 && calibration.translation.z() == 0;
}

StereoCalibration calibration_of(StereoReading pair, const CalibrationChoice& choice,
                                 const std::string& file) {
  StereoCalibration calibration{.metres_per_unit = pair.metres_per_unit, .format = pair.format};
  put_in_order(pair, file, calibration.remarks);
  choose_lenses(pair.cameras, choice.lens, file, calibration.remarks);
  calibration.left = pair.cameras[0].camera();
  calibration.right = pair.cameras[1].camera();
  calibration.rotation = pair.relative->rotation;
  calibration.translation = pair.relative->translation;
  calibration.left_from_body = pair.cameras[0].from_body;
  const auto& [left_size, right_size] = std::pair(pair.cameras[0].size, pair.cameras[1].size);
  if (left_size && right_size &&
      (left_size->width_px != right_size->width_px ||
       left_size->height_px != right_size->height_px)) {
    throw Error(fmt::format("its cameras have images of {}x{} and {}x{}, expected one size",
                            left_size->width_px, left_size->height_px, right_size->width_px,
                            right_size->height_px));
  }
  calibration.image_size = left_size ? left_size : right_size;
  calibration.is_rectified = is_pair_of_rectified(calibration);
  return calibration;
}

/// Of P1 and P2, or of Q; empty if there are none.
std::optional<StereoCalibration> rectified_of(const CalibrationNames& names,
                                              const std::array<CameraReading, 2>& cameras) {
  std::optional<StereoCalibration> calibration;
  const Found q = names.find(Value::kDepthMatrix);
  if (cameras[0].projection && cameras[1].projection) {
    calibration = from_projections(*cameras[0].projection, *cameras[1].projection);
    calibration->format = "OpenCV, P1 and P2";
  } else if (q.entry != nullptr) {
    calibration = calibration_of_depth_matrix(
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values_of(q, 4, 4).data()));
    calibration->format = "OpenCV, Q";
  }
  if (calibration) {
    calibration->image_size = cameras[0].size;
  }
  return calibration;
}

void read_unit(const CalibrationNames& names, StereoCalibration& calibration) {
  const Found unit = names.find(Value::kMetresPerUnit);
  if (unit.entry == nullptr) {
    return;
  }
  const double length = number_of(unit);
  if (!(length >= 0 && std::isfinite(length))) {
    throw Error(
        fmt::format("{} is {}, expected a number above 0, or 0 for no scale", unit.name, length));
  }
  calibration.has_scale = length > 0;
  if (length > 0) {
    calibration.metres_per_unit = length;
  }
}

}  // namespace

StereoCalibration from_names(const CalibrationNames& names, CameraChoice cameras,
                             const CalibrationChoice& choice, const std::string& file) {
  StereoReading pair;
  pair.cameras = {read_camera(names, CameraLabel::kFirst),
                  read_camera(names, CameraLabel::kSecond)};
  auto& [left, right] = pair.cameras;
  if (!right.matrix && !names.has(Value::kTranslation) && names.has(Value::kBaseline)) {
    right = left;  // ORB-SLAM3 writes the first of two rectified cameras only
  }
  std::optional<StereoCalibration> calibration;
  if (cameras == CameraChoice::kRectified || (!left.matrix && !right.matrix)) {
    calibration = rectified_of(names, pair.cameras);
  }
  if (!calibration) {
    if (!left.matrix || !right.matrix) {
      throw Error(fmt::format("there is no matrix of the {} camera: {}",
                              !left.matrix ? "left" : "right", names.found_and_taken()));
    }
    find_relative_pose(names, pair);
    if (!pair.relative) {
      throw Error(
          "it has no R and T, expected intrinsics (M1, D1, M2, D2) and extrinsics (R, T) in one "
          "file, or `calibration` INTRINSICS,EXTRINSICS");
    }
    calibration = calibration_of(pair, choice, file);
    look_at_unknown_distortion(names, pair.cameras, file, calibration->remarks);
  }
  read_unit(names, *calibration);
  return *calibration;
}

bool are_of_one_camera(const CalibrationNames& names) {
  const auto is_labelled = [&](Value value) {
    return names.find(value, CameraLabel::kFirst, CalibrationNames::Sharing::kOwn).entry !=
               nullptr ||
           names.find(value, CameraLabel::kSecond, CalibrationNames::Sharing::kOwn).entry !=
               nullptr;
  };
  return (names.has(Value::kMatrix) || names.has(Value::kFx)) && !is_labelled(Value::kMatrix) &&
         !is_labelled(Value::kFx) && !names.has(Value::kFocalBaseline) &&
         !names.has(Value::kTranslation);
}

StereoCalibration from_two_cameras(const std::array<CalibrationNames, 2>& names,
                                   CameraChoice cameras, const CalibrationChoice& choice,
                                   const std::string& file) {
  StereoReading pair;
  pair.cameras = {read_camera(names[0], CameraLabel::kNone),
                  read_camera(names[1], CameraLabel::kNone)};
  pair.metres_per_unit = 1;
  pair.may_be_swapped = true;
  const bool has_pose = find_relative_pose(pair);
  if (cameras == CameraChoice::kRectified) {
    if (auto calibration = rectified_of(names[0], pair.cameras)) {
      calibration->metres_per_unit = 1;
      return *calibration;
    }
  }
  if (!has_pose) {
    throw Error(
        "its two files do not say where the cameras are, expected projections (P) of a stereo "
        "pair, poses on a body (T_BS), or R and T in one of them");
  }
  StereoCalibration calibration = calibration_of(pair, choice, file);
  for (const CalibrationNames& of_one : names) {
    look_at_unknown_distortion(of_one, pair.cameras, file, calibration.remarks);
  }
  return calibration;
}

StereoCalibration from_right_camera(const CalibrationNames& names, CameraChoice cameras) {
  const CameraReading right = read_camera(names, CameraLabel::kNone);
  const bool is_rectified =
      right.projection && right.matrix && right.projection->leftCols<3>() == *right.matrix &&
      right.camera().is_without_distortion() &&
      right.rectification.value_or(Eigen::Matrix3d::Identity()) == Eigen::Matrix3d::Identity();
  if (!right.projection || (!is_rectified && cameras == CameraChoice::kPhotographs)) {
    throw Error(
        "it is of one camera, expected the file of the other one beside it (left.yaml and "
        "right.yaml, cam0/ and cam1/), or `calibration` LEFT,RIGHT");
  }
  Matrix34 left = *right.projection;
  left.col(3).setZero();
  StereoCalibration calibration = from_projections(left, *right.projection);
  calibration.metres_per_unit = 1;
  calibration.image_size = right.size;
  calibration.format = "ROS, right camera";
  return calibration;
}

StereoCalibration from_posed_images(const std::vector<PosedImage>& images,
                                    const std::string& file) {
  if (images.size() != 2) {
    throw Error(fmt::format("it has {} images, expected the two of a pair", images.size()));
  }
  StereoReading pair;
  pair.relative = relative_pose(images[0].pose, images[1].pose);
  pair.format = "COLMAP";
  pair.may_be_swapped = true;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [camera, size, remarks] = images[i].camera;
    pair.cameras[i].matrix = camera.matrix;
    pair.cameras[i].distortion = camera.distortion;
    pair.cameras[i].lens = camera.lens;
    pair.cameras[i].size = size;
  }
  return calibration_of(pair, {}, file);
}

}  // namespace vantage
