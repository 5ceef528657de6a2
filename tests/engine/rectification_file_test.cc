#include "engine/rectification/rectification_file.h"

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::rectification_file_test {

TEST(RectificationFile, OpenCvReadsIt) {
  std::mt19937 random(1);
  const StereoCalibration rig = random_calibration(random, 320, 200, 5);
  const RectifiedPair pair = rectified_pair(rig, 320, 200, {.kept_outline = 1});
  for (const char* name : {"a.yml", "a.yaml", "a.xml", "a.json"}) {
    const std::string text = rectification_text(name, rig, pair);
    cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    ASSERT_TRUE(file.isOpened()) << name;
    EXPECT_EQ(static_cast<int>(file["image_width"]), 320);
    const auto matrix = [&](const char* entry) {
      cv::Mat result;
      file[entry] >> result;
      return result;
    };
    const cv::Mat homography = matrix("H2");
    ASSERT_EQ(homography.size(), cv::Size(3, 3));
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(homography.at<double>(i / 3, i % 3), pair.right.homography(i / 3, i % 3), 1e-9);
    }
    // A point of the left camera's frame, by OpenCV's own functions: undistorted to its row, and
    // brought back by Q.
    const cv::Point3d point(0.1, -0.05, 6 * pair.baseline);
    const cv::Mat rotation = matrix("R");
    cv::Mat rotation_vector;
    cv::Rodrigues(rotation, rotation_vector);
    cv::Point2d rectified[2];
    for (const int side : {0, 1}) {
      std::vector<cv::Point2d> seen;
      cv::projectPoints(std::vector<cv::Point3d>{point},
                        side == 0 ? cv::Mat(cv::Mat::zeros(3, 1, CV_64F)) : rotation_vector,
                        side == 0 ? cv::Mat(cv::Mat::zeros(3, 1, CV_64F)) : matrix("T"),
                        matrix(side == 0 ? "M1" : "M2"), matrix(side == 0 ? "D1" : "D2"), seen);
      std::vector<cv::Point2d> result;
      cv::undistortPoints(seen, result, matrix(side == 0 ? "M1" : "M2"),
                          matrix(side == 0 ? "D1" : "D2"), matrix(side == 0 ? "R1" : "R2"),
                          matrix(side == 0 ? "P1" : "P2"),
                          cv::TermCriteria(cv::TermCriteria::COUNT, 100, 0));
      rectified[side] = result[0];
    }
    EXPECT_NEAR(rectified[0].y, rectified[1].y, 1e-6);
    const cv::Mat q = matrix("Q");
    const cv::Mat position = (cv::Mat_<double>(4, 1) << rectified[0].x, rectified[0].y,
                              rectified[0].x - rectified[1].x, 1);
    const cv::Mat found = q * position;
    const double depth = found.at<double>(2) / found.at<double>(3);
    const Eigen::Vector3d in_rectified_frame =
        pair.left.rotation * Eigen::Vector3d(point.x, point.y, point.z);
    EXPECT_NEAR(depth, in_rectified_frame.z(), 1e-6 * depth);
    std::vector<int> valid;
    file["valid_region"] >> valid;
    EXPECT_EQ(valid,
              (std::vector<int>{pair.valid.x, pair.valid.y, pair.valid.width, pair.valid.height}));
  }
}

TEST(RectificationFile, ServesAsCalibration) {
  std::mt19937 random(2);
  const TemporaryFolder folder;
  for (const int coefficients : {0, 5, 8}) {
    const StereoCalibration rig = random_calibration(random, 320, 200, coefficients);
    for (const char* name : {"rig.yml", "rig.xml"}) {
      const std::string path = folder / name;
      put_text(path, rectification_text(path, rig, rectified_pair(rig, 320, 200)));
      const StereoCalibration read = read_stereo_calibration(path);
      EXPECT_TRUE(read.left.matrix.isApprox(rig.left.matrix, 1e-12)) << name;
      EXPECT_TRUE(read.rotation.isApprox(rig.rotation, 1e-12));
      EXPECT_TRUE(read.translation.isApprox(rig.translation, 1e-12));
      ASSERT_TRUE(read.image_size);
      EXPECT_EQ(read.image_size->height_px, 200);
      EXPECT_EQ(read.right.is_without_distortion(), coefficients == 0);
      EXPECT_FALSE(read.is_rectified);
    }
  }
}

TEST(RectificationFile, ExtensionSaysTheFormat) {
  EXPECT_TRUE(is_rectification_extension("a/b.json"));
  EXPECT_FALSE(is_rectification_extension("a/b.txt"));
  std::mt19937 random(3);
  const StereoCalibration rig = random_calibration(random, 320, 200, 0);
  EXPECT_EQ(
      error_of([&] { (void)rectification_text("rig.txt", rig, rectified_pair(rig, 320, 200)); }),
      "'rig.txt' is not a file for matrices, expected a name that ends in .yml .yaml .xml or "
      ".json");
}

}  // namespace vantage::rectification_file_test
