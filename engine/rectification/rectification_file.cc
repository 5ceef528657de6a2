#include "engine/rectification/rectification_file.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/core/eigen.hpp>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"

namespace vantage {
namespace {

template <typename Matrix>
cv::Mat to_opencv(const Matrix& matrix) {
  cv::Mat result;
  cv::eigen2cv(matrix, result);
  return result;
}

/// A row; a column of a fisheye lens, as cv2.fisheye writes it.
cv::Mat distortion_of(const Camera& camera) {
  return camera.distortion.empty() ? cv::Mat::zeros(1, 5, CV_64F)
                                   : cv::Mat(camera.distortion, true)
                                         .reshape(1, camera.lens == LensKind::kFisheye ? 4 : 1);
}

/// Whether readers must be told what the coefficients are.
bool needs_lens_kind(const Camera& camera) {
  return camera.lens == LensKind::kFisheye || camera.distortion.size() == 4;
}

int is_fisheye(const Camera& camera) { return camera.lens == LensKind::kFisheye ? 1 : 0; }

/// Rectified pixel ← point of the left rectified camera's frame.
cv::Mat projection(const RectifiedCamera& camera, double baseline) {
  Eigen::Matrix<double, 3, 4> matrix;
  matrix << camera.matrix, Eigen::Vector3d(-camera.matrix(0, 0) * baseline, 0, 0);
  return to_opencv(matrix);
}

/// (X, Y, Z, 1) ~ Q · (x, y, d, 1).
cv::Mat depth_from_disparity(const RectifiedPair& pair) {
  const Eigen::Matrix3d& left = pair.left.matrix;
  Eigen::Matrix4d matrix;
  matrix << 1, 0, 0, -left(0, 2), 0, 1, 0, -left(1, 2), 0, 0, 0, left(0, 0), 0, 0,
      1 / pair.baseline, pair.doffs_px / pair.baseline;
  return to_opencv(matrix);
}

}  // namespace

bool is_rectification_extension(const std::filesystem::path& path) {
  constexpr std::array<const char*, 4> kExtensions = {".yml", ".yaml", ".xml", ".json"};
  return std::find(kExtensions.begin(), kExtensions.end(), path.extension()) != kExtensions.end();
}

std::string rectification_text(const std::filesystem::path& path,
                               const StereoCalibration& calibration, const RectifiedPair& pair) {
  if (!is_rectification_extension(path)) {
    throw UsageError(fmt::format(
        "'{}' is not a file for matrices, expected a name that ends in .yml .yaml .xml or .json",
        path.string()));
  }
  prepare_opencv();
  cv::FileStorage file("matrices" + path.extension().string(),
                       cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  file << "image_width" << pair.width_px << "image_height" << pair.height_px;
  file << "M1" << to_opencv(calibration.left.matrix) << "D1" << distortion_of(calibration.left);
  file << "M2" << to_opencv(calibration.right.matrix) << "D2" << distortion_of(calibration.right);
  if (needs_lens_kind(calibration.left) || needs_lens_kind(calibration.right)) {
    file << "fisheye_model1" << is_fisheye(calibration.left) << "fisheye_model2"
         << is_fisheye(calibration.right);
  }
  file << "R" << to_opencv(calibration.rotation) << "T" << to_opencv(calibration.translation);
  file << "R1" << to_opencv(pair.left.rotation) << "R2" << to_opencv(pair.right.rotation);
  file << "P1" << projection(pair.left, 0) << "P2" << projection(pair.right, pair.baseline);
  file << "Q" << depth_from_disparity(pair);
  file << "H1" << to_opencv(pair.left.homography) << "H2" << to_opencv(pair.right.homography);
  file << "baseline" << pair.baseline << "doffs" << pair.doffs_px;
  if (!calibration.has_scale || calibration.metres_per_unit) {
    file << "metres_per_unit" << (calibration.has_scale ? *calibration.metres_per_unit : 0);
  }
  file << "valid_region"
       << std::vector<int>{pair.valid.x, pair.valid.y, pair.valid.width, pair.valid.height};
  return file.releaseAndGetString();
}

}  // namespace vantage
