// Calibrations as other tools write them: one rig in each format, and depths of points that the
// test projects itself.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <filesystem>
#include <opencv2/core.hpp>

#include "engine/rectification/rectifier.h"
#include "engine/rectification/rotations.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::calibration_formats_test {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;

using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// Numbers row by row, in brackets.
template <typename Matrix>
std::string list(const Matrix& matrix) {
  std::vector<double> values;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      values.push_back(matrix(row, column));
    }
  }
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string list(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

template <typename Matrix>
std::string opencv(const std::string& name, const Matrix& matrix) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: {}\n", name,
                     matrix.rows(), matrix.cols(), list(matrix));
}

Eigen::Matrix4d transform(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

/// A rig with mild lenses, in metres.
StereoCalibration rig_of(int coefficients) {
  std::mt19937 random(7);
  StereoCalibration rig = random_calibration(random, kWidth, kHeight, coefficients, 0.05);
  rig.translation *= 0.2 / rig.baseline();
  return rig;
}

class CalibrationFormats : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = folder_ / name;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    put_text(path, text);
    return path;
  }

  /// Points of the left camera's frame are at their depths, and on equal rows.
  static void expect_depths(const StereoCalibration& read, const StereoCalibration& rig) {
    ASSERT_EQ(read.image_size ? read.image_size->width_px : kWidth, kWidth);
    const Rectifier rectifier(read, kWidth, kHeight);
    const RectifiedPair& pair = rectifier.pair();
    EXPECT_EQ(read.metres_per_unit.value_or(1), 1);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.1, -0.2, 2), {-0.4, 0.3, 3}, {0.5, 0.2, 1.7}}) {
      const auto seen = [&](const Camera& camera, const Eigen::Vector3d& of_camera, Side side) {
        return rectifier.rectified_position(
            side,
            plain_projection(camera, of_camera.x() / of_camera.z(), of_camera.y() / of_camera.z()));
      };
      const auto left = seen(rig.left, point, Side::kLeft);
      const auto right = seen(rig.right, rig.rotation * point + rig.translation, Side::kRight);
      ASSERT_TRUE(left && right);
      EXPECT_NEAR(left->y(), right->y(), 1e-5);
      EXPECT_NEAR(pair.left.matrix(0, 0) * pair.baseline / (left->x() - right->x()),
                  (pair.left.rotation * point).z(), 1e-5);
    }
  }

  TemporaryFolder folder_;
};

/// OpenCV's matrices under names that users have, in YAML, JSON of Python and nested nodes.
TEST_F(CalibrationFormats, NamesOfMatrices) {
  const StereoCalibration rig = rig_of(5);
  const Eigen::Map<const Eigen::RowVectorXd> d1(rig.left.distortion.data(), 5);
  const Eigen::Map<const Eigen::RowVectorXd> d2(rig.right.distortion.data(), 5);
  using Names = std::array<const char*, 6>;
  for (const auto& [k1, dist1, k2, dist2, r, t] :
       {Names{"M1", "D1", "M2", "D2", "R", "T"}, Names{"K1", "d1", "K2", "d2", "R", "t"},
        Names{"cameraMatrixL", "distCoeffsL", "cameraMatrixR", "distCoeffsR", "R", "T"},
        Names{"mtxL", "distL", "mtxR", "distR", "Rot", "Trans"},
        Names{"K_left", "D_left", "K_right", "D_right", "rotation_matrix", "translation_vector"},
        Names{"left_camera_matrix", "left_distortion_coefficients", "right_camera_matrix",
              "right_distortion_coefficients", "R", "T"},
        Names{"camera_matrix_1", "dist_1", "camera_matrix_2", "dist_2", "R", "T"},
        Names{"LEFT.K", "LEFT.D", "RIGHT.K", "RIGHT.D", "R", "T"},
        Names{"stereo.left.K", "stereo.left.D", "stereo.right.K", "stereo.right.D", "stereo.R",
              "stereo.T"},
        Names{"cameraMatrix0", "distCoeff0", "cameraMatrix1", "distCoeff1", "R", "T"}}) {
    const std::string text = opencv(k1, rig.left.matrix) + opencv(dist1, d1) +
                             opencv(k2, rig.right.matrix) + opencv(dist2, d2) +
                             opencv(r, rig.rotation) + opencv(t, rig.translation);
    SCOPED_TRACE(k1);
    expect_depths(read_stereo_calibration(write("c.yml", "%YAML:1.0\n---\n" + text)), rig);
  }
  const std::string json = fmt::format(
      R"({{"left": {{"K": {}, "dist": [{}]}}, "right": {{"K": {}, "dist": [{}]}}, "R": {}, "T": {}}})",
      list(rig.left.matrix), list(d1), list(rig.right.matrix), list(d2), list(rig.rotation),
      list(rig.translation));
  expect_depths(read_stereo_calibration(write("c.json", json)), rig);
}

TEST_F(CalibrationFormats, OpenCvsJsonAndXmlWithARotationVector) {
  const StereoCalibration rig = rig_of(8);
  const Eigen::AngleAxisd turn(rig.rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  for (const char* name : {"c.json", "c.xml", "c.yml"}) {
    cv::FileStorage file(folder_ / name, cv::FileStorage::WRITE);
    const auto put = [&](const char* key, const double* values, int rows, int columns) {
      file << key << cv::Mat(rows, columns, CV_64F, const_cast<double*>(values)).clone();
    };
    const Eigen::Matrix3d left = rig.left.matrix.transpose();  // rows first
    const Eigen::Matrix3d right = rig.right.matrix.transpose();
    put("M1", left.data(), 3, 3);
    put("M2", right.data(), 3, 3);
    put("D1", rig.left.distortion.data(), 1, 8);
    put("D2", rig.right.distortion.data(), 8, 1);
    put("R", vector.data(), 3, 1);
    put("T", rig.translation.data(), 1, 3);
    file.release();
    expect_depths(read_stereo_calibration(folder_ / name), rig);
  }
}

/// camera_info of both cameras, from cv::stereoRectify's point of view.
TEST_F(CalibrationFormats, RosPairs) {
  const StereoCalibration rig = rig_of(5);
  const Rectifier rectifier(rig, kWidth, kHeight);
  const RectifiedPair& pair = rectifier.pair();
  const auto text = [&](const Camera& camera, const RectifiedCamera& rectified, double shift) {
    Matrix34 projection = Matrix34::Zero();
    projection.leftCols<3>() = rectified.matrix;
    projection(0, 3) = -rectified.matrix(0, 0) * shift;
    const auto matrix = [](const char* name, int rows, int columns, const std::string& data) {
      return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: {}\n", name, rows, columns, data);
    };
    return "image_width: 96\nimage_height: 72\ncamera_name: one\n" +
           matrix("camera_matrix", 3, 3, list(camera.matrix)) + "distortion_model: plumb_bob\n" +
           matrix("distortion_coefficients", 1, 5, list(camera.distortion)) +
           matrix("rectification_matrix", 3, 3, list(rectified.rotation)) +
           matrix("projection_matrix", 3, 4, list(projection));
  };
  const std::string left = write("left.yaml", text(rig.left, pair.left, 0));
  const std::string right = write("right.yaml", text(rig.right, pair.right, pair.baseline));
  for (const std::string& name : {left, right, left + "," + right}) {
    expect_depths(read_stereo_calibration(name), rig);
  }
  EXPECT_EQ(calibration_files(right).size(), 2U);
  // Exchanged files: the projections tell who is left.
  const StereoCalibration exchanged = read_stereo_calibration(right + "," + left);
  expect_depths(exchanged, rig);
  EXPECT_THAT(exchanged.remarks.at(0).text, HasSubstr("to the left of the first one"));
  // Of images that are rectified, one file tells all.
  const StereoCalibration rectified = read_rectified_calibration(right);
  EXPECT_NEAR(rectified.baseline(), pair.baseline, 1e-9);
  std::filesystem::remove(left);
  EXPECT_NEAR(read_rectified_calibration(right).baseline(), pair.baseline, 1e-9);
  EXPECT_THAT(error_of([&] { read_stereo_calibration(right); }), HasSubstr("of the other one"));
  // Monocular calibrations have no Tx.
  const std::string same = write("left.yaml", text(rig.left, pair.left, pair.baseline));
  EXPECT_THAT(error_of([&] { read_stereo_calibration(right); }), HasSubstr("have the same Tx"));
}

std::string kalibr_camera(int number, const Camera& camera, const char* model,
                          const std::string& pose) {
  const Eigen::Matrix3d& k = camera.matrix;
  return fmt::format(
      "cam{}:\n{}  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: {}\n"
      "  distortion_model: {}\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [96, 72]\n"
      "  rostopic: /cam/image_raw\n",
      number, pose, list(camera.distortion), model, k(0, 0), k(1, 1), k(0, 2), k(1, 2));
}

/// Rows as Kalibr writes them, one per line.
std::string rows(const std::string& name, const Eigen::Matrix4d& matrix) {
  std::string text = "  " + name + ":\n";
  for (int row = 0; row < 4; ++row) {
    text += "  - " + list(Eigen::RowVector4d(matrix.row(row))) + "\n";
  }
  return text;
}

TEST_F(CalibrationFormats, KalibrChains) {
  const StereoCalibration rig = rig_of(4);
  const Eigen::Matrix4d right_of_left = transform(rig.rotation, rig.translation);
  const auto of = [&](int number, const Camera& camera, const std::string& pose) {
    return kalibr_camera(number, camera, "radtan", pose);
  };
  expect_depths(
      read_stereo_calibration(write(
          "c.yaml", of(0, rig.left, "") + of(1, rig.right, rows("T_cn_cnm1", right_of_left)))),
      rig);
  // cam0 is the right camera.
  const StereoCalibration exchanged = read_stereo_calibration(
      write("c.yaml",
            of(0, rig.right, "") + of(1, rig.left, rows("T_cn_cnm1", right_of_left.inverse()))));
  expect_depths(exchanged, rig);
  EXPECT_EQ(exchanged.remarks.size(), 1U);
  // Poses of the IMU in both cameras.
  const Eigen::Matrix4d left_of_imu = transform(rotation_by({0.3, 1, -0.2}), {0.1, 0.2, 0.3});
  expect_depths(
      read_stereo_calibration(
          write("c.yaml", of(0, rig.left, rows("T_cam_imu", left_of_imu)) +
                              of(1, rig.right, rows("T_cam_imu", right_of_left * left_of_imu)))),
      rig);
  EXPECT_THAT(
      error_of([&] {
        read_stereo_calibration(write(
            "c.yaml", kalibr_camera(0, rig.left, "fov", "") +
                          kalibr_camera(1, rig.right, "fov", rows("T_cn_cnm1", right_of_left))));
      }),
      HasSubstr("the lens model fov"));
}

TEST_F(CalibrationFormats, EurocSensors) {
  const StereoCalibration rig = rig_of(4);
  const Eigen::Matrix4d body_of_left = transform(rotation_by({0.3, 1, -0.2}), {0.1, 0.2, 0.3});
  const Eigen::Matrix4d body_of_right =
      body_of_left * transform(rig.rotation, rig.translation).inverse();
  const auto text = [](const Camera& camera, const Eigen::Matrix4d& pose) {
    const Eigen::Matrix3d& k = camera.matrix;
    return fmt::format(
        "# of 2016\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: {}\nrate_hz: 20\n"
        "resolution: [96, 72]\ncamera_model: pinhole\nintrinsics: [{}, {}, {}, {}] #fu, fv, cu, "
        "cv\ndistortion_model: radial-tangential\ndistortion_coefficients: {}\n",
        list(pose), k(0, 0), k(1, 1), k(0, 2), k(1, 2), list(camera.distortion));
  };
  write("cam1/sensor.yaml", text(rig.right, body_of_right));
  expect_depths(read_stereo_calibration(write("cam0/sensor.yaml", text(rig.left, body_of_left))),
                rig);
}

TEST_F(CalibrationFormats, OrbSlamSettings) {
  const StereoCalibration rig = rig_of(4);
  const auto camera = [](int number, const Camera& lens) {
    const Eigen::Matrix3d& k = lens.matrix;
    const std::vector<double>& d = lens.distortion;
    return fmt::format(
        "Camera{0}.fx: {1}\nCamera{0}.fy: {2}\nCamera{0}.cx: {3}\nCamera{0}.cy: {4}\n"
        "Camera{0}.k1: {5}\nCamera{0}.k2: {6}\nCamera{0}.p1: {7}\nCamera{0}.p2: {8}\n",
        number, k(0, 0), k(1, 1), k(0, 2), k(1, 2), d[0], d[1], d[2], d[3]);
  };
  const std::string text =
      "%YAML:1.0\n\nFile.version: \"1.0\"\n\nCamera.type: \"PinHole\"\n" + camera(1, rig.left) +
      camera(2, rig.right) + "Camera.width: 96\nCamera.height: 72\n" +
      opencv("Stereo.T_c1_c2", transform(rig.rotation, rig.translation).inverse().eval());
  expect_depths(read_stereo_calibration(write("three.yaml", text)), rig);

  // Version 2: rectifications and projections of both, and of the rectified images.
  const Rectifier rectifier(rig, kWidth, kHeight);
  const RectifiedPair& pair = rectifier.pair();
  const double bf = pair.left.matrix(0, 0) * pair.baseline;
  const auto side = [&](const char* name, const Camera& lens, const RectifiedCamera& rectified,
                        double tx) {
    Matrix34 projection = Matrix34::Zero();
    projection.leftCols<3>() = rectified.matrix;
    projection(0, 3) = tx;
    const std::string prefix = name;
    return prefix + ".height: 72\n" + prefix + ".width: 96\n" + opencv(prefix + ".K", lens.matrix) +
           opencv(prefix + ".D", Eigen::Map<const Eigen::RowVectorXd>(lens.distortion.data(), 4)) +
           opencv(prefix + ".R", rectified.rotation) + opencv(prefix + ".P", projection);
  };
  const std::string rectified_camera = fmt::format(
      "Camera.fx: {0}\nCamera.fy: {0}\nCamera.cx: {1}\nCamera.cy: {2}\nCamera.k1: 0.0\n"
      "Camera.k2: 0.0\nCamera.bf: {3}\n",
      pair.left.matrix(0, 0), pair.left.matrix(0, 2), pair.left.matrix(1, 2), bf);
  expect_depths(
      read_stereo_calibration(write("two.yaml", "%YAML:1.0\n" + rectified_camera +
                                                    side("LEFT", rig.left, pair.left, 0) +
                                                    side("RIGHT", rig.right, pair.right, -bf))),
      rig);
  // The same matrices as OpenCV's stereoRectify has them: the unit is not known.
  const StereoCalibration of_opencv = read_stereo_calibration(
      write("one.yaml", "%YAML:1.0\n" + side("LEFT", rig.left, pair.left, 0) +
                            side("RIGHT", rig.right, pair.right, -bf)));
  expect_depths(of_opencv, rig);
  EXPECT_FALSE(of_opencv.metres_per_unit);
  const StereoCalibration rectified =
      read_stereo_calibration(write("rectified.yaml", rectified_camera));
  EXPECT_TRUE(rectified.is_rectified);
  EXPECT_NEAR(rectified.baseline(), pair.baseline, 1e-9);
  // Version 3 has one camera for rectified images.
  const StereoCalibration of_one = read_stereo_calibration(write(
      "one_camera.yaml", "%YAML:1.0\nCamera.type: \"Rectified\"\n" +
                             camera(1, {.matrix = pair.left.matrix, .distortion = {0, 0, 0, 0}}) +
                             "Stereo.b: 0.12\n"));
  EXPECT_TRUE(of_one.is_rectified);
  EXPECT_NEAR(of_one.baseline(), 0.12, 1e-9);
  // OpenVSLAM: the same, with a node of the rectification.
  std::string open = fmt::format(
      "Camera:\n  model: perspective\n  fx: {}\n  fy: {}\n  cx: 1\n"
      "  cy: 1\n  cols: 96\n  rows: 72\n  focal_x_baseline: {}\n"
      "StereoRectifier:\n  model: perspective\n",
      pair.left.matrix(0, 0), pair.left.matrix(0, 0), bf);
  for (const auto& [name, lens, of] :
       {std::tuple{"left", &rig.left, &pair.left}, {"right", &rig.right, &pair.right}}) {
    open += fmt::format("  K_{0}: {1}\n  D_{0}: {2}\n  R_{0}: {3}\n", name, list(lens->matrix),
                        list(lens->distortion), list(of->rotation));
  }
  expect_depths(read_stereo_calibration(write("open.yaml", open)), rig);
}

/// COLMAP's model of two images, and its fisheye lenses.
TEST_F(CalibrationFormats, ColmapPairs) {
  StereoCalibration rig = rig_of(4);
  const auto camera = [](int number, const Camera& lens) {
    const Eigen::Matrix3d& k = lens.matrix;
    return fmt::format("{} {} 96 72 {} {} {} {} {}\n", number,
                       lens.lens == LensKind::kFisheye ? "OPENCV_FISHEYE" : "OPENCV", k(0, 0),
                       k(1, 1), k(0, 2) + 0.5, k(1, 2) + 0.5, fmt::join(lens.distortion, " "));
  };
  // The left camera stands somewhere in the world.
  const CameraPose left{.rotation = rotation_by({0.3, 1, -0.2}), .translation = {0.1, 0.2, 0.3}};
  const CameraPose right{.rotation = rig.rotation * left.rotation,
                         .translation = rig.rotation * left.translation + rig.translation};
  const auto image = [](int camera_number, const char* name, const CameraPose& pose) {
    const Eigen::Quaterniond q(pose.rotation);
    const Eigen::Vector3d& t = pose.translation;
    return fmt::format("{} {} {} {} {} {} {} {} {} {}\n\n", camera_number, q.w(), q.x(), q.y(),
                       q.z(), t.x(), t.y(), t.z(), camera_number, name);
  };
  write("images.txt", image(1, "b.png", left) + image(2, "a.png", right));
  expect_depths(
      read_stereo_calibration(write("cameras.txt", camera(1, rig.left) + camera(2, rig.right))),
      rig);
  expect_depths(read_stereo_calibration(folder_.path()), rig);
  rig.left.lens = LensKind::kFisheye;
  write("cameras.txt", camera(1, rig.left) + camera(2, rig.right));
  const StereoCalibration read = read_stereo_calibration(folder_.path());
  EXPECT_EQ(read.left.lens, LensKind::kFisheye);
  EXPECT_EQ(read.right.lens, LensKind::kStandard);
  EXPECT_EQ(read.left.distortion, rig.left.distortion);
}

TEST_F(CalibrationFormats, OtherNumbersThanKittis) {
  const StereoCalibration read = read_stereo_calibration(
      write("c.txt",
            "S_101: 1920 1080\nK_101: 2000 0 960 0 2000 540 0 0 1\nD_101: 0 0 0 0 0\n"
            "R_101: 1 0 0 0 1 0 0 0 1\nT_101: 0 0 0\nS_rect_101: 640 480\n"
            "P_rect_101: 700 0 320 0 0 700 240 0 0 0 1 0\nT_103: -.5 0 0\n"
            "P_rect_103: 700 0 320 -378 0 700 240 0 0 0 1 0\n"));
  EXPECT_TRUE(read.is_rectified);
  EXPECT_NEAR(read.baseline(), 0.54, 1e-12);
  EXPECT_EQ(read.image_size->width_px, 640);
}

TEST_F(CalibrationFormats, DistortionIsNeverLeftOut) {
  const StereoCalibration rig = rig_of(5);
  const auto text = [&](const std::string& name) {
    return opencv("K1", rig.left.matrix) + opencv("K2", rig.right.matrix) +
           opencv("R", rig.rotation) + opencv("T", rig.translation) +
           fmt::format("{}: {}\n", name, list(rig.left.distortion));
  };
  const auto problem = [&](const std::string& name) {
    return error_of([&] { read_stereo_calibration(write("c.yml", text(name))); });
  };
  for (const char* name : {"dist_of_the_left", "left_lens_distorsion", "RadialCoefs1"}) {
    EXPECT_THAT(problem(name), HasSubstr(fmt::format("{} looks like distortion", name)));
  }
  EXPECT_EQ(problem("distance"), "");
  EXPECT_EQ(problem("left_dist"), "");
  // What is found and what is taken.
  const std::string none = error_of(
      [&] { read_stereo_calibration(write("c.yml", "kamera: 1\n" + opencv("R", rig.rotation))); });
  for (const char* part :
       {"it has R, kamera;", "cameraMatrix1, mtx1", "distCoeffs1", "left and right"}) {
    EXPECT_THAT(none, HasSubstr(part));
  }
}

TEST_F(CalibrationFormats, FourCoefficientsAreAskedFor) {
  const StereoCalibration rig = rig_of(4);
  const auto text = [&](int rows, const std::string& more) {
    const auto d = [&](const char* name, const Camera& camera) {
      const Eigen::Map<const Eigen::VectorXd> column(camera.distortion.data(), 4);
      return rows == 4 ? opencv(name, column) : opencv(name, column.transpose().eval());
    };
    return more + opencv("K1", rig.left.matrix) + d("D1", rig.left) +
           opencv("K2", rig.right.matrix) + d("D2", rig.right) + opencv("R", rig.rotation) +
           opencv("T", rig.translation);
  };
  const std::string column = write("column.yml", text(4, ""));
  EXPECT_THAT(error_of([&] { read_stereo_calibration(column); }),
              HasSubstr("D1 is 4x1 and no key says of which lens, expected `lens` fisheye"));
  for (const LensKind kind : {LensKind::kStandard, LensKind::kFisheye}) {
    EXPECT_EQ(read_stereo_calibration(column, {.lens = kind}).left.lens, kind);
  }
  const StereoCalibration row = read_stereo_calibration(write("row.yml", text(1, "")));
  EXPECT_EQ(row.left.lens, LensKind::kStandard);
  EXPECT_THAT(row.remarks.at(0).text, HasSubstr("count as k1 k2 p1 p2"));
  for (const char* key : {"distortion_model: equidistant\n", "fisheye: true\n",
                          "camera_model: \"KANNALA_BRANDT\"\n", "fisheye_model: 1\n"}) {
    const StereoCalibration told = read_stereo_calibration(write("told.yml", text(4, key)));
    EXPECT_EQ(told.right.lens, LensKind::kFisheye) << key;
    EXPECT_TRUE(told.remarks.empty());
  }
  EXPECT_EQ(
      read_stereo_calibration(write("told.yml", text(4, "distortion_model: radtan\n"))).left.lens,
      LensKind::kStandard);
}

TEST_F(CalibrationFormats, AnotherSizeOfTheImages) {
  StereoCalibration rig = rig_of(5);
  rig.image_size = ImageSize{kWidth, kHeight};
  const StereoCalibration half = rig.for_images(kWidth / 2, kHeight / 2);
  ASSERT_EQ(half.remarks.size(), 1U);
  // A point is where the middle of the 2×2 pixels is.
  const Eigen::Vector2d seen = plain_projection(rig.left, 0.1, -0.2);
  EXPECT_LT((plain_projection(half.left, 0.1, -0.2) - (seen.array() / 2 - 0.25).matrix()).norm(),
            1e-9);
  EXPECT_EQ(Rectifier(rig, kWidth / 2, kHeight / 2).pair().remarks.size(), 1U);
  // Cropped, and of another shape.
  for (const auto& [width, height] : {std::pair(92, 69), {48, 30}, {72, 96}}) {
    EXPECT_TRUE(rig.for_images(width, height).remarks.empty());
    EXPECT_THAT(
        error_of([&, width = width, height = height] { (void)rectified_pair(rig, width, height); }),
        HasSubstr("but the calibration is for 96x72"));
  }
}

}  // namespace
}  // namespace vantage::calibration_formats_test
