#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "engine/io/files/text_lines.h"
#include "engine/rectification/calibration/posed_images.h"
#include "engine/view_geometry/colmap_model.h"
#include "engine/view_geometry/intrinsics_file.h"
#include "engine/view_geometry/nerf_transforms.h"
#include "engine/view_geometry/trajectory_file.h"
#include "tests/engine/engine_test.h"

namespace vantage::pose_files_test {

/// A quarter turn about Y, camera to world: the camera looks along the world's X.
const Eigen::Matrix3d kToTheRight =
    Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();

void expect_looks_to_the_right(const CameraPose& pose) {
  const Eigen::Vector3d ahead = pose.rotation.transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((ahead - Eigen::Vector3d::UnitX()).norm(), 1e-7);
  EXPECT_LT((pose.centre() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-7);
}

std::string problem_of_trajectory(const std::string& text) {
  return error_of([&] { parse_trajectory(text, "poses.txt"); });
}

TEST(TrajectoryFile, TumHoldsCameraToWorldWithTheRealPartLast) {
  const Trajectory read = parse_trajectory(
      "# time tx ty tz qx qy qz qw\r\n\r\n"
      "1305031102.1753 1 2 3 0 0.70710678118 0 0.70710678118\r\n"
      "1305031102.2753 0 0 0 0 0 0 1\r\n",
      "poses.txt");
  EXPECT_EQ(read.format, "TUM");
  EXPECT_THAT(read.times_s, ElementsAre(1305031102.1753, 1305031102.2753));
  expect_looks_to_the_right(read.poses[0]);
  EXPECT_TRUE(read.poses[1].rotation.isIdentity(0));
}

TEST(TrajectoryFile, KittiHoldsRowsOfCameraToWorld) {
  for (const char* text : {"0 0 1 1 0 1 0 2 -1 0 0 3\n", "0 0 1 1 0 1 0 2 -1 0 0 3 0 0 0 1"}) {
    const Trajectory read = parse_trajectory(text, "poses.txt");
    EXPECT_EQ(read.format, "KITTI");
    EXPECT_THAT(read.times_s, IsEmpty());
    expect_looks_to_the_right(read.poses[0]);
  }
}

TEST(TrajectoryFile, MayBeginWithAByteOrderMarkButIsText) {
  const std::string line = "0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(parse_trajectory("\xEF\xBB\xBF" + line, "poses.txt").poses.size(), 1U);
  EXPECT_THAT(problem_of_trajectory(line + std::string(1, '\0')), HasSubstr("is not a text"));
}

TEST(TrajectoryFile, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(problem_of_trajectory("# nothing\n"), HasSubstr("poses.txt: holds no poses"));
  EXPECT_THAT(problem_of_trajectory("\n1 2 3\n"), HasSubstr("poses.txt line 2: holds 3 values"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 0 0 0 0 1\n1 0 0 1\n"),
              HasSubstr("line 2: holds 4 values, expected 8 as the first pose"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 0 0 0 0 2\n"), HasSubstr("length 1"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 x 0 0 0 1\n"),
              HasSubstr("value 4 is 'x', expected a finite number"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 nan 0 0 0 1\n"), HasSubstr("value 4 is 'nan'"));
  EXPECT_THAT(problem_of_trajectory("1 0 -1e300 0 0 0 0 1\n"), HasSubstr("coordinate of 1e+300"));
  EXPECT_THAT(problem_of_trajectory("2 0 0 0 0 1 0 0 0 0 1 0\n"), HasSubstr("with a rotation"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 0 0 1 0 0 0 0 -1 0\n"), HasSubstr("with a rotation"));
  EXPECT_THAT(problem_of_trajectory("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2\n"), HasSubstr("0 0 0 1"));
  EXPECT_THAT(problem_of_trajectory(std::string("1\0 2", 4)), HasSubstr("is not a text"));
}

constexpr const char* kCameras =
    "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
    "1 SIMPLE_RADIAL 640 480 500 320 240 -0.1\n"
    "2 OPENCV 640 480 500 510 320.5 240.5 -0.1 0.02 0.001 -0.002\n"
    "3 PINHOLE 64 48 50 51 32 24\n";

TEST(ColmapModel, CamerasWithPixelCentresAtWholeNumbers) {
  const auto cameras = parse_colmap_cameras(kCameras, "cameras.txt");
  ASSERT_EQ(cameras.size(), 3U);
  const Camera& radial = cameras.at(1).camera;
  EXPECT_EQ(radial.matrix(0, 0), 500);
  EXPECT_EQ(radial.matrix(1, 1), 500);
  EXPECT_EQ(radial.matrix(0, 2), 319.5);
  EXPECT_EQ(radial.matrix(1, 2), 239.5);
  EXPECT_THAT(radial.distortion, ElementsAre(-0.1, 0, 0, 0));
  EXPECT_THAT(cameras.at(2).camera.distortion, ElementsAre(-0.1, 0.02, 0.001, -0.002));
  EXPECT_EQ(cameras.at(2).camera.matrix(1, 1), 510);
  EXPECT_THAT(cameras.at(3).camera.distortion, IsEmpty());
  EXPECT_EQ(cameras.at(3).size.height_px, 48);
}

std::string problem_of_cameras(const std::string& text) {
  return error_of([&] { parse_colmap_cameras(text, "cameras.txt"); });
}

TEST(ColmapModel, SaysWhatIsWrongWithCameras) {
  EXPECT_THAT(problem_of_cameras("1 PINHOLE 640\n"), HasSubstr("cameras.txt line 1: holds 3"));
  EXPECT_THAT(problem_of_cameras("1 PINHOLE 64 48 50 51 32\n"),
              HasSubstr("PINHOLE has 3 parameters, expected 4"));
  EXPECT_THAT(problem_of_cameras("1 THIN_PRISM_FISHEYE 64 48 1 1 1 1 0 0 0 0\n"),
              HasSubstr("'THIN_PRISM_FISHEYE', expected SIMPLE_PINHOLE"));
  EXPECT_THAT(problem_of_cameras("1 PINHOLE 64 48 -50 51 32 24\n"),
              HasSubstr("line 1: the camera 1's fx is -50"));
  EXPECT_THAT(problem_of_cameras("x PINHOLE 64 48 50 51 32 24\n"), HasSubstr("CAMERA_ID is 'x'"));
  EXPECT_THAT(problem_of_cameras("1 PINHOLE 0 48 50 51 32 24\n"), HasSubstr("WIDTH is '0'"));
  EXPECT_THAT(problem_of_cameras("1 PINHOLE 64 48 50 51 32 24\n1 PINHOLE 64 48 50 51 32 24\n"),
              HasSubstr("line 2: camera 1 is given twice"));
}

std::vector<PosedImage> images_in(const std::string& text) {
  return parse_colmap_images(text, "images.txt", parse_colmap_cameras(kCameras, "cameras.txt"));
}

TEST(ColmapModel, ImagesHoldWorldToCameraAndLinesOfPointsAreSkipped) {
  const Eigen::Matrix3d rotation = kToTheRight.transpose();
  const Eigen::Vector3d t = -rotation * Eigen::Vector3d(1, 2, 3);
  const std::string pose = "0.70710678118 0 -0.70710678118 0 " + std::to_string(t.x()) + " " +
                           std::to_string(t.y()) + " " + std::to_string(t.z());
  const std::vector<PosedImage> images =
      images_in("# Image list\n7 " + pose + " 3 b.png\n1.5 2.5 -1 3 4 17\n8 " + pose +
                " 1 a folder/a.png\n\n9 1 0 0 0 0 0 0 1 c.png\n");
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ(images[0].name, "a folder/a.png");
  EXPECT_EQ(images[1].name, "b.png");
  EXPECT_EQ(images[1].camera.size.width_px, 64);
  expect_looks_to_the_right(images[1].pose);
}

TEST(ColmapModel, LinesOfPointsMayBeMissing) {
  EXPECT_EQ(images_in("1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n").size(), 2U);
}

TEST(ColmapModel, SaysWhatIsWrongWithImages) {
  const auto problem = [](const std::string& text) { return error_of([&] { images_in(text); }); };
  EXPECT_THAT(problem("1 1 0 0 0 0 0 0 1\n"), HasSubstr("images.txt line 1: holds 9 values"));
  EXPECT_THAT(problem("1 2 0 0 0 0 0 0 1 a.png\n"), HasSubstr("does not have length 1"));
  EXPECT_THAT(problem("\n1 1 0 0 0 0 0 0 5 a.png\n"),
              HasSubstr("line 2: CAMERA_ID is 5, expected a camera of cameras.txt"));
  EXPECT_THAT(problem("1 1 0 0 0 0 inf 0 1 a.png\n"), HasSubstr("TY is 'inf'"));
  EXPECT_THAT(problem("1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 0 0 0 1 a.png\n"),
              HasSubstr("'a.png' is given twice"));
}

TEST(ColmapModel, AFolderNeedsTheTextModel) {
  const TemporaryFolder folder;
  put_text(folder.path() / "cameras.bin", "x");
  EXPECT_THAT(error_of([&] { read_colmap_model(folder.path()); }), HasSubstr("model_converter"));
  put_text(folder.path() / "cameras.txt", kCameras);
  put_text(folder.path() / "images.txt", "# none\n");
  EXPECT_THAT(error_of([&] { read_colmap_model(folder.path()); }), HasSubstr("holds no images"));
  put_text(folder.path() / "images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n");
  EXPECT_EQ(read_colmap_model(folder.path()).size(), 1U);
}

TEST(IntrinsicsFile, EveryFormat) {
  const std::string opencv =
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
      "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 500., 0., 320., 0., 510., 240., 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
      "   data: [ -0.1, 0.02, 0., 0., 0.003 ]\n";
  for (const std::string& text :
       {opencv, std::string("# fx fy cx cy k1 k2 p1 p2 k3\n500 510 320 240 -0.1 0.02 0 0 0.003\n"),
        std::string("1 FULL_OPENCV 640 480 500 510 320.5 240.5 -0.1 0.02 0 0 0.003 0 0 0\n")}) {
    const SizedCamera read = parse_intrinsics(text, "camera");
    Eigen::Matrix3d expected;
    expected << 500, 0, 320, 0, 510, 240, 0, 0, 1;
    EXPECT_EQ(read.camera.matrix, expected) << text;
    ASSERT_GE(read.camera.distortion.size(), 5U);
    EXPECT_EQ(read.camera.distortion[0], -0.1);
    EXPECT_EQ(read.camera.distortion[4], 0.003);
  }
  EXPECT_EQ(parse_intrinsics(opencv, "camera").size.height_px, 480);
  EXPECT_EQ(parse_intrinsics("P0: 7 0 6 0 0 7 5 0 0 0 1 0\nP1: 7 0 6 -3 0 7 5 0 0 0 1 0\n", "c")
                .camera.matrix(1, 2),
            5);
  EXPECT_EQ(parse_intrinsics("7 0 6 0 0 7 5 0 0 0 1 0\n", "c").camera.matrix(0, 2), 6);
}

TEST(IntrinsicsFile, CameraOfKitti) {
  // cx is the number of the camera.
  const auto line = [](const char* name, int camera) {
    return fmt::format("{} 7 0 {} 0 0 7 5 0 0 0 1 0\n", name, camera);
  };
  const auto cx = [](const std::string& text, int camera) {
    return parse_intrinsics(text, "calib.txt", {.kitti_camera = camera}).camera.matrix(0, 2);
  };
  std::string named;
  std::string raw;
  std::string numbers;
  for (int camera = 0; camera < 4; ++camera) {
    named += line(fmt::format("P{}:", camera).c_str(), camera);
    raw += line(fmt::format("P_rect_0{}:", camera).c_str(), camera);
    numbers += line("", camera);
  }
  for (int camera = 0; camera < 4; ++camera) {
    EXPECT_EQ(cx(named, camera), camera);
    EXPECT_EQ(cx(raw, camera), camera);
    EXPECT_EQ(cx(numbers, camera), camera);
  }
  const std::string colour = line("P2:", 2) + line("P3:", 3);
  EXPECT_EQ(cx(colour, 3), 3);
  EXPECT_EQ(cx(colour, 0), 2);
  EXPECT_EQ(cx(line("", 2) + line("", 3), 3), 3);
}

TEST(IntrinsicsFile, SaysWhatIsWrong) {
  const auto problem = [](const std::string& text) {
    return error_of([&] { parse_intrinsics(text, "camera.yml"); });
  };
  EXPECT_THAT(problem("nothing\n"),
              HasSubstr("camera.yml: there is no camera matrix: it has no names"));
  EXPECT_THAT(problem("K: [1, 2]\n"), HasSubstr("K has 2 values, expected a 3x3 matrix"));
  EXPECT_THAT(problem("-500 510 320 240\n"), HasSubstr("camera.yml: the camera's fx is -500"));
  EXPECT_THAT(problem("1 PINHOLE 4 4 1 1 1 1\n2 PINHOLE 4 4 1 1 1 1\n"),
              HasSubstr("holds 2 cameras, expected one"));
  EXPECT_THAT(problem("distortion_model: omni\nK: [9,0,1,0,9,1,0,0,1]\n"), HasSubstr("omni"));
}

TEST(IntrinsicsFile, OpenCvPosesAreRotationVectors) {
  const std::string text =
      "%YAML:1.0\nextrinsic_parameters: !!opencv-matrix\n   rows: 2\n   cols: 6\n   dt: d\n"
      "   data: [ 0., -1.57079632679, 0., 3., -2., -1.,\n       0., 0., 0., 4., 5., 6. ]\n";
  EXPECT_TRUE(has_opencv_poses(text, "poses.yml"));
  EXPECT_FALSE(has_opencv_poses("1 0 0 0 0 0 0 1\n", "poses.txt"));
  EXPECT_THAT(error_of([] { (void)has_opencv_poses("{{", "poses.json"); }),
              StartsWith("poses.json: JSON:1:2: "));
  const std::vector<CameraPose> poses = parse_opencv_poses(text, "camera.yml");
  ASSERT_EQ(poses.size(), 2U);
  expect_looks_to_the_right(poses[0]);
  EXPECT_EQ(poses[1].translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(error_of([&] { parse_opencv_poses("extrinsic_parameters: [1, 2]\n", "c.yml"); }),
              HasSubstr("c.yml: extrinsic_parameters has 2 values, expected rows of six"));
}

TEST(CameraPose, RelativePosesBringPointsFromOneCameraToTheOther) {
  const CameraPose first = CameraPose::from_camera_to_world(kToTheRight, {1, 2, 3});
  const CameraPose second = CameraPose::from_camera_to_world(
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {4, 0, 1});
  const CameraPose relative = relative_pose(first, second);
  const Eigen::Vector3d point(0.5, -3, 7);
  const auto seen = [&](const CameraPose& pose) {
    return Eigen::Vector3d(pose.rotation * point + pose.translation);
  };
  EXPECT_LT((relative.rotation * seen(first) + relative.translation - seen(second)).norm(), 1e-12);
}

/// One pose as each format writes it: a camera at (1, 2, 3) that looks along the world's X.
TEST(TrajectoryFile, FormatsAgree) {
  // Columns: the camera's right, down and forward in the world, whose Z is up.
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Vector3d centre(1, 2, 3);
  const Eigen::Quaterniond q(axes);
  const std::string tum = fmt::format("0.5 1 2 3 {} {} {} {}\n", q.x(), q.y(), q.z(), q.w());
  const std::string body =
      fmt::format("1403636579763555584,1,2,3,{},{},{},{}", q.w(), q.x(), q.y(), q.z());
  const std::string euroc = "#timestamp, p_RS_R_x [m], ...\n" + body + ",0,0,0,0,0,0,0,0,0\n";
  Eigen::Matrix3d opengl = axes;  // right, up, back
  opengl.rightCols<2>() *= -1;
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    rows += fmt::format("[{}, {}, {}, {}], ", opengl(row, 0), opengl(row, 1), opengl(row, 2),
                        centre[row]);
  }
  const std::string frame =
      R"({"file_path": "images/b", "transform_matrix": [)" + rows + R"([0, 0, 0, 1]]})";
  const std::string nerf = R"({"camera_model": "OPENCV_FISHEYE", "fl_x": 50, "fl_y": 51, "cx": 32,
      "cy": 24, "w": 64, "h": 48, "k1": 0.1, "k4": 0.01, "frames": [)" +
                           frame + "]}";
  for (const std::string& text : {tum, body + "\n", euroc, nerf}) {
    const Trajectory read = parse_trajectory(text, "poses");
    ASSERT_EQ(read.poses.size(), 1U);
    EXPECT_TRUE(read.poses[0].rotation.isApprox(axes.transpose(), 1e-9)) << text;
    EXPECT_TRUE(read.poses[0].centre().isApprox(centre, 1e-9)) << text;
    EXPECT_EQ(read.is_of_body, read.format == "EuRoC");
    if (read.is_of_body) {
      EXPECT_NEAR(read.times_s[0], 1403636579.763555584, 1e-6);
    }
  }
  // A camera on the body, 1 to its left and turned: it is where both poses say.
  CameraPose on_body{.rotation = axes, .translation = {1, 0, 0}};
  const CameraPose of_camera = parse_trajectory(euroc, "poses").of_camera(on_body).poses[0];
  const Eigen::Vector3d point(4, 5, 6);
  const Eigen::Vector3d of_body = axes.transpose() * (point - centre);
  EXPECT_TRUE((of_camera.rotation * point + of_camera.translation)
                  .isApprox(axes * of_body + Eigen::Vector3d(1, 0, 0), 1e-9));

  const SizedCamera camera =
      parse_nerf_transforms(nerf, "t.json", [](const std::string&) { return ImageSize(); })
          .at(0)
          .camera;
  EXPECT_EQ(camera.camera.lens, LensKind::kFisheye);
  EXPECT_EQ(camera.camera.distortion, (std::vector<double>{0.1, 0, 0, 0.01}));
  EXPECT_EQ(camera.camera.matrix(0, 2), 31.5);
  // The synthetic scenes have a field of view alone.
  const std::string blender =
      R"({"camera_angle_x": 1.5707963267948966, "frames": [)" + frame + "]}";
  const Camera narrow = parse_nerf_transforms(blender, "t.json",
                                              [](const std::string& name) {
                                                EXPECT_EQ(name, "images/b");
                                                return ImageSize{100, 80};
                                              })
                            .at(0)
                            .camera.camera;
  EXPECT_NEAR(narrow.matrix(1, 1), 50, 1e-9);
  EXPECT_EQ(narrow.matrix(1, 2), 39.5);
  for (const char* text : {"{}", R"({"frames": [{}]})", R"({"frames": [{"file_path": "a"}]})",
                           R"({"frames": [{"file_path": "a", "transform_matrix": [[1]]}]})"}) {
    EXPECT_THAT(error_of([&] { parse_trajectory(text, "t.json"); }), HasSubstr("t.json"));
  }
}

}  // namespace vantage::pose_files_test
