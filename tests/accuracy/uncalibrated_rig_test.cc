#include "engine/rectification/uncalibrated_rig.h"

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include "engine/rectification/improved_rectification.h"
#include "engine/rectification/rectifier.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/match_cases.h"
#include "tests/test_paths.h"

namespace vantage::uncalibrated_rig_test {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// RMS and largest |y_left − y_right| of matches once rectified.
struct Rows {
  double rms_px = 0;
  double max_px = 0;
};

Rows rows_of(const StereoCalibration& calibration, const std::vector<PointMatch>& matches) {
  const Rectifier rectifier(calibration, kWidth, kHeight);
  Rows rows;
  for (const PointMatch& match : matches) {
    const auto left = rectifier.rectified_position(Side::kLeft, match.left);
    const auto right = rectifier.rectified_position(Side::kRight, match.right);
    if (!left || !right) {
      ADD_FAILURE() << "a match cannot be rectified";
      continue;
    }
    const double error = std::abs(left->y() - right->y());
    rows.rms_px += error * error / static_cast<double>(matches.size());
    rows.max_px = std::max(rows.max_px, error);
  }
  rows.rms_px = std::sqrt(rows.rms_px);
  return rows;
}

TEST(UncalibratedRig, ExactMatchesGiveExactRows) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2; ++trial) {
    const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
    const auto matches = exact_matches(truth, kWidth, kHeight, 150, random);
    const UncalibratedRig rig = estimate_rig(matches, kWidth, kHeight);
    EXPECT_EQ(rig.inliers, 150);
    EXPECT_NEAR(rig.calibration.translation.norm(), 1, 1e-12);
    // Matches that it has not seen: it is the geometry that is right.
    const auto others = exact_matches(truth, kWidth, kHeight, 100, random);
    EXPECT_LT(rows_of(rig.calibration, matches).max_px, 1e-6) << "trial " << trial;
    EXPECT_LT(rows_of(rig.calibration, others).max_px, 1e-5) << "trial " << trial;
    const RectifiedPair pair = rectified_pair(rig.calibration, kWidth, kHeight);
    for (const PointMatch& match : matches) {
      const Eigen::Vector3d left = pair.left.homography * match.left.homogeneous();
      const Eigen::Vector3d right = pair.right.homography * match.right.homogeneous();
      EXPECT_NEAR(left.hnormalized().y(), right.hnormalized().y(), 1e-6);
    }
  }
}

TEST(UncalibratedRig, WrongAndInexactMatchesAreTold) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 2; ++trial) {
    const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
    auto matches = exact_matches(truth, kWidth, kHeight, 400, random);
    spoil(matches, kWidth, kHeight, 0.3, 40, random);
    const UncalibratedRig rig = estimate_rig(matches, kWidth, kHeight);
    int right_kept = 0;
    int wrong_kept = 0;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      (i * 37 % 100 < 40 ? wrong_kept : right_kept) += rig.is_inlier[i] ? 1 : 0;
    }
    EXPECT_GT(right_kept, 225) << "of 240";
    EXPECT_LT(wrong_kept, 10) << "of 160";
    EXPECT_EQ(rig.inliers, right_kept + wrong_kept);
    EXPECT_NEAR(rig.rms_px, 0.3, 0.08);
    const auto others = exact_matches(truth, kWidth, kHeight, 300, random);
    EXPECT_LT(rows_of(rig.calibration, others).rms_px, 0.3) << "trial " << trial;
  }
}

TEST(UncalibratedRig, FindsLensDistortion) {
  std::mt19937 random(3);
  for (const double k1 : {-0.25, 0.1}) {
    StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
    truth.left.distortion = {k1, 0, 0, 0};
    truth.right.distortion = {k1 + 0.02, 0, 0, 0};
    auto matches = exact_matches(truth, kWidth, kHeight, 600, random);
    spoil(matches, kWidth, kHeight, 0.2, 20, random);
    const UncalibratedRig rig = estimate_rig(matches, kWidth, kHeight);
    const auto others = exact_matches(truth, kWidth, kHeight, 300, random);
    EXPECT_LT(rows_of(rig.calibration, others).rms_px, 0.4) << k1;
    // It takes the lens for it: rows of straight lenses would be off by much more.
    StereoCalibration straight = rig.calibration;
    straight.left.distortion.clear();
    straight.right.distortion.clear();
    EXPECT_GT(rows_of(straight, others).rms_px, 1) << k1;
  }
}

/// Singular values of a homography's derivative.
Eigen::Vector2d stretch_of(const Eigen::Matrix3d& homography, double x, double y) {
  const auto at = [&](double u, double v) {
    return Eigen::Vector2d((homography * Eigen::Vector3d(u, v, 1)).hnormalized());
  };
  Eigen::Matrix2d derivative;
  derivative << at(x + 0.5, y) - at(x - 0.5, y), at(x, y + 0.5) - at(x, y - 0.5);
  return Eigen::JacobiSVD<Eigen::Matrix2d>(derivative).singularValues();
}

/// How much longer than wide small circles become, at most over the image.
double largest_stretch(const Eigen::Matrix3d& homography) {
  double largest = 1;
  for (const double x : {0.0, kWidth / 2.0, kWidth - 1.0}) {
    for (const double y : {0.0, kHeight / 2.0, kHeight - 1.0}) {
      const Eigen::Vector2d stretch = stretch_of(homography, x, y);
      largest = std::max(largest, stretch[0] / stretch[1]);
    }
  }
  return largest;
}

TEST(UncalibratedRig, HardlyStretchesTheImages) {
  std::mt19937 random(4);
  constexpr int kTrials = 4;
  double sum = 0;
  double opencv_sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0, 0.05);
    auto matches = exact_matches(truth, kWidth, kHeight, 300, random);
    spoil(matches, kWidth, kHeight, 0.3, 0, random);
    const RectifiedPair pair =
        rectified_pair(estimate_rig(matches, kWidth, kHeight).calibration, kWidth, kHeight);
    std::vector<cv::Point2d> left;
    std::vector<cv::Point2d> right;
    for (const PointMatch& match : matches) {
      left.emplace_back(match.left.x(), match.left.y());
      right.emplace_back(match.right.x(), match.right.y());
    }
    cv::Mat homographies[2];
    ASSERT_TRUE(cv::stereoRectifyUncalibrated(left, right, cv::findFundamentalMat(left, right),
                                              {kWidth, kHeight}, homographies[0], homographies[1]));
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const double stretch = largest_stretch(pair.camera(side).homography);
      EXPECT_LT(stretch, 1.25) << "trial " << trial;
      sum += stretch;
      const cv::Mat& other = homographies[index_of(side)];
      Eigen::Matrix3d matrix;
      for (int i = 0; i < 9; ++i) {
        matrix(i / 3, i % 3) = other.at<double>(i / 3, i % 3);
      }
      opencv_sum += largest_stretch(matrix);
    }
  }
  EXPECT_LT(sum - 2 * kTrials, 0.5 * (opencv_sum - 2 * kTrials))
      << "two images a trial; 1 = not stretched at all";
}

TEST(UncalibratedRig, TheSameFromAnyThread) {
  std::mt19937 random(5);
  const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 5);
  auto matches = exact_matches(truth, kWidth, kHeight, 200, random);
  spoil(matches, kWidth, kHeight, 0.3, 30, random);
  const UncalibratedRig expected = estimate_rig(matches, kWidth, kHeight);
  std::vector<UncalibratedRig> others(1);
  std::vector<std::thread> threads;
  for (UncalibratedRig& other : others) {
    threads.emplace_back([&] { other = estimate_rig(matches, kWidth, kHeight); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const UncalibratedRig& other : others) {
    EXPECT_EQ(other.calibration.left.matrix, expected.calibration.left.matrix);
    EXPECT_EQ(other.calibration.rotation, expected.calibration.rotation);
    EXPECT_EQ(other.calibration.translation, expected.calibration.translation);
    EXPECT_EQ(other.is_inlier, expected.is_inlier);
  }
}

TEST(UncalibratedRig, RefusesWhatTellsNothing) {
  std::mt19937 random(6);
  const StereoCalibration usual = random_calibration(random, kWidth, kHeight, 0);
  const auto error_for = [](const StereoCalibration& rig, double sigma, std::mt19937& numbers) {
    auto matches = exact_matches(rig, kWidth, kHeight, 200, numbers);
    spoil(matches, kWidth, kHeight, sigma, 10, numbers);
    return error_of([&] { (void)estimate_rig(matches, kWidth, kHeight); });
  };
  const auto few = exact_matches(usual, kWidth, kHeight, 19, random);
  EXPECT_EQ(error_of([&] { (void)estimate_rig(few, kWidth, kHeight); }),
            "the images have 19 points in common, expected at least 20");

  auto unrelated = exact_matches(usual, kWidth, kHeight, 200, random);
  spoil(unrelated, kWidth, kHeight, 0, 100, random);
  EXPECT_THAT(error_of([&] { (void)estimate_rig(unrelated, kWidth, kHeight); }),
              HasSubstr("agree with one rig, expected at least 20 and 30 %"));

  for (const double sigma : {0.0, 0.3}) {
    // Everything is so far away that only the turn is seen.
    auto matches = exact_matches(usual, kWidth, kHeight, 200, random, 1e6, 1e7);
    spoil(matches, kWidth, kHeight, sigma, 10, random);
    EXPECT_THAT(error_of([&] { (void)estimate_rig(matches, kWidth, kHeight); }),
                HasSubstr("as if the camera had only turned"));

    if (sigma == 0) {
      continue;
    }
    StereoCalibration forward = usual;
    forward.translation = {0.05, -0.02, -1};
    EXPECT_THAT(error_for(forward, sigma, random),
                HasSubstr("the epipole lies inside the left image"));
  }
  EXPECT_THAT(error_of([&] { (void)estimate_rig(few, 1, 480); }), HasSubstr("1x480"));
}

TEST(UncalibratedRig, CamerasAboveEachOtherAreSaidToBe) {
  std::mt19937 random(7);
  StereoCalibration rig = random_calibration(random, kWidth, kHeight, 0);
  rig.translation = {0.1, -1, 0.05};
  const auto matches = exact_matches(rig, kWidth, kHeight, 200, random);
  const UncalibratedRig found = estimate_rig(matches, kWidth, kHeight);
  EXPECT_THAT(error_of([&] { (void)rectified_pair(found.calibration, kWidth, kHeight); }),
              HasSubstr("expected cameras side by side"));
}

TEST(UncalibratedRig, TheLeftCameraStaysLeft) {
  std::mt19937 random(8);
  const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
  auto matches = exact_matches(truth, kWidth, kHeight, 200, random);
  for (PointMatch& match : matches) {
    std::swap(match.left, match.right);
  }
  const UncalibratedRig rig = estimate_rig(matches, kWidth, kHeight);
  EXPECT_LT(rig.calibration.rotation.row(0).dot(rig.calibration.translation.transpose()), -0.9);
  EXPECT_LT(rows_of(rig.calibration, matches).max_px, 1e-6);
}

TEST(UncalibratedRig, RectifiesTheChessboardFromItsCorners) {
  const std::filesystem::path folder = test_paths::shared_data() / "chessboard";
  std::ifstream file(folder / "corners.txt");
  if (!file) {
    GTEST_SKIP() << "no chessboard photographs at " << folder;
  }
  std::map<std::string, std::vector<PointMatch>> pairs;
  std::vector<PointMatch> all;
  for (std::string line; std::getline(file, line);) {
    std::istringstream values(line);
    std::string image;
    double number, board_x, board_y;
    PointMatch match;
    if (values >> image >> number >> board_x >> board_y >> match.left.x() >> match.left.y() >>
        match.right.x() >> match.right.y()) {
      pairs[image].push_back(match);
      all.push_back(match);
    }
  }
  ASSERT_EQ(all.size(), 13U * 54U);
  const UncalibratedRig rig = estimate_rig(all, kWidth, kHeight);
  EXPECT_GT(rig.inliers, 660);
  EXPECT_LT(rows_of(rig.calibration, all).rms_px, 0.35);
  // A single board is a plane, which tells less; but its own rows correspond, those of a few
  // corners excepted that were found in the wrong place.
  int number = 0;
  for (const auto& [image, matches] : pairs) {
    if (number++ % 4 != 0) {
      continue;
    }
    const UncalibratedRig single = estimate_rig(matches, kWidth, kHeight);
    EXPECT_GE(single.inliers, 48) << image;
    std::vector<PointMatch> inliers;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (single.is_inlier[i]) {
        inliers.push_back(matches[i]);
      }
    }
    EXPECT_LT(rows_of(single.calibration, inliers).rms_px, 0.3) << image;
  }
}

RigValidation validation_of(const std::vector<PointMatch>& matches) {
  return validate_rig(estimate_rig(matches, kWidth, kHeight), matches, kWidth, kHeight, {});
}

TEST(RigValidation, ExactMatchesEverywhereHoldWhereTheyAreLeftOut) {
  std::mt19937 random(4);
  const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
  const RigValidation found = validation_of(exact_matches(truth, kWidth, kHeight, 600, random));
  ASSERT_TRUE(found.held_out);
  EXPECT_LT(found.held_out->rms_px, 1e-3);
  EXPECT_GT(found.held_out->inliers, 550);
  EXPECT_GT(found.covered_share, 0.9);
}

TEST(RigValidation, TellsOfFewInexactMatchesAndOfPartsWithoutAny) {
  std::mt19937 random(5);
  const StereoCalibration truth = random_calibration(random, kWidth, kHeight, 0);
  std::vector<PointMatch> matches;
  std::normal_distribution<double> noise_px(0, 0.3);
  for (PointMatch match : exact_matches(truth, kWidth, kHeight, 1000, random)) {
    if (match.left.x() < 0.5 * kWidth - 0.5 && match.left.y() < 0.5 * kHeight - 0.5) {
      match.right.y() += noise_px(random);
      matches.push_back(match);
    }
  }
  const UncalibratedRig rig = estimate_rig(matches, kWidth, kHeight);
  const RigValidation found = validate_rig(rig, matches, kWidth, kHeight, {});
  EXPECT_LE(found.covered_share, 0.25);
  EXPECT_GT(found.covered_share, 0.2);
  ASSERT_TRUE(found.held_out);
  EXPECT_GT(found.held_out->rms_px, rows_of(rig.calibration, matches).rms_px);
  matches.resize(30);  // half of them are too few
  EXPECT_FALSE(validation_of(matches).held_out);
}

}  // namespace vantage::uncalibrated_rig_test
