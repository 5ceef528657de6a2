// Lenses of cv::fisheye, with its functions as the oracle.
#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "engine/rectification/rectification_file.h"
#include "engine/rectification/rectifier.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::fisheye_test {
namespace {

Camera wide_camera(double focal_px) {
  Camera camera;
  camera.matrix << focal_px, 0, 81.3, 0, 1.01 * focal_px, 58.4, 0, 0, 1;
  camera.distortion = {0.05, -0.02, 0.01, -0.003};
  camera.lens = LensKind::kFisheye;
  return camera;
}

cv::Mat matrix_of(const Eigen::Matrix3d& matrix) {
  cv::Mat result;
  cv::eigen2cv(matrix, result);
  return result;
}

cv::Vec4d coefficients_of(const Camera& camera) {
  return {camera.distortion[0], camera.distortion[1], camera.distortion[2], camera.distortion[3]};
}

TEST(Fisheye, LensIsOpenCvs) {
  const Camera camera = wide_camera(45);
  const LensModel lens(camera);
  std::vector<cv::Point2d> rays;
  for (double x = -4; x <= 4; x += 0.5) {
    for (double y = -3; y <= 3; y += 0.75) {
      rays.emplace_back(x, y);
    }
  }
  std::vector<cv::Point2d> expected;
  cv::fisheye::distortPoints(rays, expected, matrix_of(camera.matrix), coefficients_of(camera));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector2d ray(rays[i].x, rays[i].y);
    const auto position = lens.position_of(ray);
    ASSERT_TRUE(position);
    EXPECT_LT((*position - Eigen::Vector2d(expected[i].x, expected[i].y)).norm(), 1e-9);
    const auto again = lens.ray_of(*position);
    ASSERT_TRUE(again) << ray.transpose();
    EXPECT_LT((*again - ray).norm(), 1e-7);
  }
  EXPECT_FALSE(lens.position_of({6, 0}));  // beyond 80 degrees
  EXPECT_FALSE(lens.ray_of({225, 58}));
  EXPECT_FALSE(camera.is_without_distortion());
  Camera equidistant = camera;
  equidistant.distortion = {0, 0, 0, 0};
  EXPECT_FALSE(equidistant.is_without_distortion());
}

TEST(Fisheye, RectifiesAsOpenCv) {
  StereoCalibration rig;
  rig.left = wide_camera(45);
  rig.right = wide_camera(46);
  rig.rotation = Eigen::AngleAxisd(0.04, Eigen::Vector3d(0.3, 0.8, 0.5).normalized());
  rig.translation = {-0.1, 0.004, 0.003};
  const Rectifier rectifier(rig, 160, 120);
  const RectifiedPair& pair = rectifier.pair();
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Camera& camera = side == Side::kLeft ? rig.left : rig.right;
    cv::Mat x;
    cv::Mat y;
    cv::fisheye::initUndistortRectifyMap(
        matrix_of(camera.matrix), coefficients_of(camera), matrix_of(pair.camera(side).rotation),
        matrix_of(pair.camera(side).matrix), cv::Size(160, 120), CV_32FC1, x, y);
    const auto [x_px, y_px] = rectifier.source_positions(side);
    for (int row = 0; row < 120; row += 3) {
      for (int column = 0; column < 160; column += 3) {
        ASSERT_NEAR(x_px.at(column, row), x.at<float>(row, column), 2e-3);
        ASSERT_NEAR(y_px.at(column, row), y.at<float>(row, column), 2e-3);
      }
    }
  }
  // What is written is read back, and has OpenCV's shape.
  const TemporaryFolder folder;
  for (const char* name : {"rig.yml", "rig.xml", "rig.json"}) {
    const std::string path = folder / name;
    put_text(path, rectification_text(path, rig, pair));
    const StereoCalibration read = read_stereo_calibration(path);
    EXPECT_EQ(read.left.lens, LensKind::kFisheye);
    EXPECT_EQ(read.right.distortion, rig.right.distortion);
    EXPECT_TRUE(read.remarks.empty());
    cv::Mat coefficients;
    cv::FileStorage(path, cv::FileStorage::READ)["D1"] >> coefficients;
    EXPECT_EQ(coefficients.size(), cv::Size(1, 4));
  }
}

TEST(Fisheye, UndistortsAsOpenCv) {
  const Camera camera = wide_camera(55);
  Execution execution({.threads = 1});
  Photograph photograph;
  Image<float>& pixels = photograph.pixels.emplace<Image<float>>(160, 120);
  cv::Mat source(120, 160, CV_32FC1);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      pixels.at(x, y) = 0.5F + 0.4F * std::sin(0.05F * static_cast<float>(x)) *
                                   std::cos(0.04F * static_cast<float>(y));
      source.at<float>(y, x) = pixels.at(x, y);
    }
  }
  cv::Mat expected;
  cv::fisheye::undistortImage(source, expected, matrix_of(camera.matrix), coefficients_of(camera),
                              matrix_of(camera.matrix));
  const Photograph result = undistorted(std::move(photograph), camera, execution);
  double worst = 0;
  for (int y = 10; y < 110; ++y) {
    for (int x = 10; x < 150; ++x) {
      worst = std::max<double>(worst, std::abs(std::get<Image<float>>(result.pixels).at(x, y) -
                                               expected.at<float>(y, x)));
    }
  }
  EXPECT_LT(worst, 2e-3);  // OpenCV's is bilinear
}

}  // namespace
}  // namespace vantage::fisheye_test
