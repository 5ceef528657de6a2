#include "engine/rectification/stereo_calibration.h"

#include <Eigen/Dense>

#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::stereo_calibration_test {

const char* const kYaml = R"(%YAML:1.0
---
image_width: 640
image_height: 480
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3574739548494938e+02, 0., 3.4235286877260381e+02, 0.,
       5.3558947999393411e+02, 2.3502912394475777e+02, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -2.6e-01, -4.7e-02, 1.7e-03, -2.9e-04, 2.4e-01 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 539., 0., 328., 0., 538., 248., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ -0.28, 0.098, -4.2e-04, 1.0e-03 ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0.96, 0., 0.28, 0., 1., 0., -0.28, 0., 0.96 ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -8.3e-02, 9.6e-04, -7.5e-06 ]
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 5.1886240175089677e+02, 0., 3.3767753982543945e+02, 0., 0.,
       5.1886240175089677e+02, 2.4391416931152344e+02, 0., 0., 0., 1., 0. ]
)";

const char* const kXml = R"(<?xml version="1.0"?>
<opencv_storage>
<!-- <M1>broken</M1> -->
<imageSize>
  640 480</imageSize>
<cameraMatrix1 type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    535. 0. 342. 0. 534. 235. 0. 0. 1.</data></cameraMatrix1>
<distCoeffs1 type_id="opencv-matrix">
  <rows>1</rows>
  <cols>5</cols>
  <dt>d</dt>
  <data>
    -2.6e-01 0. 0. 0. 1.</data></distCoeffs1>
<cameraMatrix2 type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    539. 0. 328. 0. 538. 248. 0. 0. 1.</data></cameraMatrix2>
<R type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    1. 0. 0. 0. 1. 0. 0. 0. 1.</data></R>
<T type_id="opencv-matrix">
  <rows>3</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    -80. 1. 0.</data></T>
</opencv_storage>
)";

const char* const kMiddlebury =
    "cam0=[999.421 0 294.182; 0 999.421 252.932; 0 0 1]\n"
    "cam1=[999.421 0 326.96; 0 999.421 252.932; 0 0 1]\n"
    "doffs=32.778\nbaseline=193.001\nwidth=741\nheight=497\nndisp=70\nisint=0\n";

const char* const kKitti =
    "P0: 7.0e+02 0 6.0e+02 0 0 7.0e+02 1.8e+02 0 0 0 1 0\n"
    "P1: 7.0e+02 0 6.0e+02 -3.5e+02 0 7.0e+02 1.8e+02 0 0 0 1 0\n"
    "P2: 7.0e+02 0 6.0e+02 4.2e+01 0 7.0e+02 1.8e+02 0 0 0 1 0\n"
    "P3: 7.0e+02 0 6.0e+02 -3.78e+02 0 7.0e+02 1.8e+02 0 0 0 1 0\n"
    "R0_rect: 1 0 0 0 1 0 0 0 1\n";

const char* const kKalibr =
    "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.02, 0.0, 0.0]\n"
    "  distortion_model: equidistant\n  intrinsics: [300.0, 301.0, 159.5, 119.5]\n"
    "  resolution: [320, 240]\ncam1:\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.12]\n"
    "  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n  distortion_coeffs: []\n  distortion_model: none\n"
    "  intrinsics: [300.0, 300.0, 159.5, 119.5]\n  resolution: [320, 240]\n";

const char* const kOrbSlam =
    "%YAML:1.0\nCamera.fx: 300.0\nCamera.fy: 300.0\nCamera.cx: 159.5\nCamera.cy: 119.5\n"
    "Camera.k1: 0.0\nCamera.bf: 36.0\n";

const char* const kJson = R"({"left": {"K": [[500, 0, 320], [0, 500, 240], [0, 0, 1]],
  "dist": {"type_id": "opencv-matrix", "rows": 5, "cols": 1, "dt": "d", "data": [0.1, 0, 0, 0, 1]}},
  "right": {"K": [500, 0, 320, 0, 500, 240, 0, 0, 1], "dist": []},
  "R": [0, 0.1, 0], "T": [[-0.1], [0], [0]], "image_size": [640, 480], "lens_model": "radtan"})";

class CalibrationFiles : public testing::Test {
 protected:
  StereoCalibration read(const std::string& text) {
    put_text(file_, text);
    return read_stereo_calibration(file_);
  }
  /// Error of the text, without the name of the file that it has to begin with.
  std::string error(const std::string& text) {
    const std::string whole = error_of([&] { read(text); });
    EXPECT_EQ(whole.find('\n'), std::string::npos) << whole;
    const std::string name = file_ + ": ";
    EXPECT_EQ(whole.substr(0, name.size()), name);
    return whole.size() < name.size() ? whole : whole.substr(name.size());
  }
  static std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  }

  TemporaryFolder folder_;
  std::string file_ = folder_ / "calibration.any";
};

TEST_F(CalibrationFiles, OpenCvYaml) {
  const StereoCalibration calibration = read(kYaml);
  EXPECT_EQ(calibration.format, "OpenCV");
  EXPECT_FALSE(calibration.is_rectified);
  ASSERT_TRUE(calibration.image_size);
  EXPECT_EQ(calibration.image_size->width_px, 640);
  EXPECT_EQ(calibration.image_size->height_px, 480);
  EXPECT_EQ(calibration.left.matrix(0, 0), 5.3574739548494938e+02);
  EXPECT_EQ(calibration.left.matrix(0, 2), 3.4235286877260381e+02);
  EXPECT_EQ(calibration.left.matrix(1, 1), 5.3558947999393411e+02);
  EXPECT_EQ(calibration.right.matrix(1, 2), 248);
  EXPECT_EQ(calibration.left.distortion,
            (std::vector<double>{-2.6e-01, -4.7e-02, 1.7e-03, -2.9e-04, 2.4e-01}));
  EXPECT_EQ(calibration.right.distortion.size(), 4U);
  EXPECT_NEAR(calibration.rotation(0, 2), 0.28, 1e-12);
  EXPECT_NEAR(calibration.rotation(2, 0), -0.28, 1e-12);
  EXPECT_EQ(calibration.translation, Eigen::Vector3d(-8.3e-02, 9.6e-04, -7.5e-06));
}

TEST_F(CalibrationFiles, OpenCvNamesAndSequences) {
  std::string text = kYaml;
  for (const auto& [name, other] :
       {std::pair{"M1:", "K1:"}, {"M2:", "K2:"}, {"D2:", "distCoeffs2:"}}) {
    text = replaced(text, name, other);
  }
  text = replaced(text, "image_width: 640\nimage_height: 480", "imageSize: [ 640, 480 ]");
  text = replaced(text, "\n---\n", "\r\n");
  const StereoCalibration calibration = read(text);
  EXPECT_EQ(calibration.left.matrix(0, 0), 5.3574739548494938e+02);
  EXPECT_EQ(calibration.right.distortion.size(), 4U);
  EXPECT_EQ(calibration.image_size->height_px, 480);
  // By hand, without OpenCV's header and tags.
  const StereoCalibration by_hand = read(
      "\xEF\xBB\xBF# of 2024\nimage_size:\n  - 640\n  - 480\n"
      "K1: [[500, 0, 320], [0, +501.5, 240], [0, 0, 1]]\n"
      "K2: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"
      "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.1, 0, 0]\n");
  EXPECT_EQ(by_hand.left.matrix(1, 1), 501.5);
  EXPECT_EQ(by_hand.image_size->width_px, 640);
  EXPECT_TRUE(by_hand.left.distortion.empty());
  EXPECT_FALSE(by_hand.is_rectified);
}

TEST_F(CalibrationFiles, OpenCvXml) {
  const StereoCalibration calibration = read(kXml);
  EXPECT_EQ(calibration.left.matrix(1, 1), 534);
  EXPECT_EQ(calibration.right.matrix(0, 2), 328);
  EXPECT_EQ(calibration.left.distortion, (std::vector<double>{-0.26, 0, 0, 0, 1}));
  EXPECT_TRUE(calibration.right.distortion.empty());
  EXPECT_EQ(calibration.translation, Eigen::Vector3d(-80, 1, 0));
  EXPECT_EQ(calibration.image_size->width_px, 640);
}

TEST_F(CalibrationFiles, OpenCvOfRectifiedCameras) {
  const std::string text =
      "M1: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nM2: [500, 0, 330, 0, 500, 240, 0, 0, 1]\n"
      "D1: [0, 0, 0, 0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.1, 0, 0]\n";
  EXPECT_TRUE(read(text).is_rectified);
  EXPECT_EQ(read(text).doffs_px(), 10);
  EXPECT_FALSE(read(replaced(text, "D1: [0", "D1: [0.001")).is_rectified);
  EXPECT_FALSE(read(replaced(text, "330, 0, 500", "330, 0, 501")).is_rectified);
  EXPECT_FALSE(read(replaced(text, "-0.1, 0", "-0.1, 0.001")).is_rectified);
}

/// Files with the cameras of rectified images alone, or beside those of the photographs.
TEST_F(CalibrationFiles, OpenCvOfRectifiedImages) {
  const std::string projections =
      "P1: [500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0]\n"
      "P2: [500, 0, 330, -60, 0, 500, 240, 0, 0, 0, 1, 0]\n";
  const std::string q = "Q: [1, 0, 0, -320, 0, 1, 0, -240, 0, 0, 0, 500, 0, 0, 8, 80]\n";
  for (const std::string& text : {projections, q, projections + q}) {
    const StereoCalibration calibration = read(text);
    EXPECT_TRUE(calibration.is_rectified);
    EXPECT_EQ(calibration.left.matrix(0, 0), 500);
    EXPECT_EQ(calibration.left.matrix(0, 2), 320);
    EXPECT_EQ(calibration.left.matrix(1, 2), 240);
    EXPECT_NEAR(calibration.doffs_px(), 10, 1e-9);
    EXPECT_NEAR(calibration.baseline(), text == q ? 0.125 : 0.12, 1e-12);
    EXPECT_FALSE(calibration.metres_per_unit);
    EXPECT_TRUE(calibration.has_scale);
  }
  EXPECT_NEAR(read(q).baseline(), 0.125, 1e-12);
  EXPECT_EQ(read(q + "metres_per_unit: 0.01\n").metres_per_unit, 0.01);
  EXPECT_FALSE(read(q + "metres_per_unit: 0\n").has_scale);
  EXPECT_THAT(error(q + "metres_per_unit: -1\n"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(error(replaced(q, "8, 80", "-8, 80")), HasSubstr("Q is not that of cameras"));

  // kYaml has P1 too.
  const std::string both =
      std::string(kYaml) +
      "P2: [518.86240175, 0, 337.7, -43, 0, 518.86240175, 243.914, 0, 0, 0, 1, 0]\n";
  EXPECT_FALSE(read(both).is_rectified);
  EXPECT_NEAR(read_rectified_calibration(file_).baseline(), 43 / 518.86240175, 1e-6);
  put_text(file_, kYaml);
  EXPECT_FALSE(read_rectified_calibration(file_).is_rectified);
}

TEST_F(CalibrationFiles, Middlebury) {
  const StereoCalibration calibration = read(kMiddlebury);
  EXPECT_EQ(calibration.format, "Middlebury");
  EXPECT_TRUE(calibration.is_rectified);
  EXPECT_EQ(calibration.metres_per_unit, 0.001);
  EXPECT_EQ(calibration.left.matrix(0, 0), 999.421);
  EXPECT_EQ(calibration.left.matrix(1, 2), 252.932);
  EXPECT_EQ(calibration.baseline(), 193.001);
  EXPECT_NEAR(calibration.doffs_px(), 32.778, 1e-9);
  EXPECT_EQ(calibration.image_size->width_px, 741);
  EXPECT_EQ(calibration.image_size->height_px, 497);
}

TEST_F(CalibrationFiles, Kitti) {
  const StereoCalibration grey = read(kKitti);
  EXPECT_EQ(grey.format, "KITTI, cameras 0 and 1");
  EXPECT_TRUE(grey.is_rectified);
  EXPECT_EQ(grey.metres_per_unit, 1);
  EXPECT_EQ(grey.left.matrix(0, 0), 700);
  EXPECT_NEAR(grey.baseline(), 0.5, 1e-12);
  EXPECT_NEAR(grey.translation.x(), -0.5, 1e-12);
  EXPECT_FALSE(grey.image_size);

  const std::string text = kKitti;
  const StereoCalibration colour = read(text.substr(text.find("P2")));
  EXPECT_EQ(colour.format, "KITTI, cameras 2 and 3");
  EXPECT_NEAR(colour.baseline(), 0.6, 1e-12);
  EXPECT_EQ(colour.kitti_cameras, KittiCameras::kColour);
  EXPECT_FALSE(colour.has_other_cameras);

  put_text(file_, text);
  EXPECT_TRUE(grey.has_other_cameras);
  EXPECT_NEAR(read_stereo_calibration(file_, {.kitti_cameras = KittiCameras::kColour}).baseline(),
              0.6, 1e-12);
  EXPECT_NEAR(read_rectified_calibration(file_, {.kitti_cameras = KittiCameras::kGrey}).baseline(),
              0.5, 1e-12);
  put_text(file_, text.substr(text.find("P2")));
  EXPECT_EQ(
      error_of([&] { read_stereo_calibration(file_, {.kitti_cameras = KittiCameras::kGrey}); }),
      file_ + ": there is no P0 in it, expected a 3x4 matrix");
  put_text(file_, kMiddlebury);
  EXPECT_EQ(
      error_of([&] { read_stereo_calibration(file_, {.kitti_cameras = KittiCameras::kGrey}); }),
      file_ + ": has format Middlebury, expected KITTI: only its cameras are selected");

  std::string raw = "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n";
  raw += replaced(replaced(text.substr(0, text.find("P2")), "P0", "P_rect_00"), "P1", "P_rect_01");
  raw += "S_rect_00: 1.242000e+03 3.750000e+02\nR_00: 1 0 0 0 1 0 0 0 1\n";
  EXPECT_EQ(read(raw).image_size->width_px, 1242);
  EXPECT_NEAR(read(raw).baseline(), 0.5, 1e-12);

  const std::string nameless =
      replaced(replaced(text.substr(0, text.find("P2")), "P0: ", ""), "P1: ", "");
  EXPECT_EQ(read(nameless).format, "KITTI, cameras 0 and 1");
  EXPECT_NEAR(read(nameless).baseline(), 0.5, 1e-12);
}

TEST_F(CalibrationFiles, ErrorsNameWhatIsWrong) {
  EXPECT_THAT(error("hello\n"),
              HasSubstr("no matrix of the left camera: it has no names; expected"));
  EXPECT_THAT(error(replaced(kYaml, "M1:", "M3:")),
              HasSubstr("no matrix of the left camera: it has D1, D2, M2, M3, P1, R, T, image_"));
  EXPECT_EQ(error(replaced(kYaml, "5.3574739548494938e+02", "five")),
            "M1 holds 'five', expected finite numbers");
  EXPECT_EQ(error(replaced(kYaml, "5.3574739548494938e+02", ".Nan")),
            "M1 holds '.Nan', expected finite numbers");
  EXPECT_EQ(error(replaced(kYaml, "5.3574739548494938e+02", "inf")),
            "M1 holds 'inf', expected finite numbers");
  EXPECT_EQ(error(replaced(kYaml, "5.3574739548494938e+02,", "")),
            "M1 holds 8 numbers, which are not its rows x cols");
  EXPECT_EQ(error(replaced(kYaml, "R: !!opencv-matrix\n   rows: 3\n   cols: 3",
                           "R: !!opencv-matrix\n   rows: 9\n   cols: 1")),
            "R is a 9x1 matrix, expected 3x3");
  EXPECT_EQ(error(replaced(kYaml, "-4.7e-02, ", "").replace(0, 0, "")).substr(0, 17),
            "D1 holds 4 number");
  EXPECT_EQ(error(std::string(kYaml).substr(0, std::string(kYaml).find("R: "))),
            "it has no R and T, expected intrinsics (M1, D1, M2, D2) and extrinsics (R, T) in one "
            "file, or `calibration` INTRINSICS,EXTRINSICS");
  EXPECT_EQ(error(replaced(kYaml, "0.96, 0., 0.28", "0.9, 0., 0.28")).substr(0, 52),
            "R is not a rotation: its columns deviate from orthon");
  EXPECT_EQ(error(replaced(kYaml, "0., 1., 0., -0.28", "0., -1., 0., -0.28")),
            "R is mirrored: its determinant is -1, expected 1");
  EXPECT_EQ(error(replaced(kYaml, "-8.3e-02, 9.6e-04, -7.5e-06", "0, 0, 0")),
            "the baseline (length of T) is 0, expected 1e-9 to 1e9");
  EXPECT_EQ(error(replaced(kYaml, "image_width: 640", "image_width: 640.5")),
            "the image size holds 640.5, expected whole pixels");
  EXPECT_EQ(error(replaced(kYaml, "image_height: 480\n", "")),
            "there is image_width, but no height of the images");
  EXPECT_EQ(error(replaced(kXml, "</T>", "</t>")), "T is not complete");
  EXPECT_EQ(error(replaced(kXml, "<cameraMatrix2", "<cameraMatrix3")).substr(0, 35),
            "there is no matrix of the right cam");
  EXPECT_EQ(error(replaced(kMiddlebury, "doffs=32.778", "doffs=30")),
            "doffs is 30, but cx of cam1 is 32.778 more than of cam0");
  EXPECT_EQ(error(replaced(kMiddlebury, "baseline=193.001\n", "")),
            "there is no baseline in it, expected a number");
  EXPECT_EQ(error(replaced(kMiddlebury, "cam1", "cam2")),
            "there is no cam1 in it, expected a 3x3 matrix");
  EXPECT_EQ(error(replaced(kMiddlebury, "326.96; 0 999.421", "326.96; 0 998")),
            "the cameras are said to be rectified, but their fy is 999.421 and 998 pixels, "
            "expected the same to 0.01");
  EXPECT_EQ(error(replaced(kMiddlebury, "baseline=193.001", "baseline=-193.001")),
            "the right camera is to the left of the left one, expected the cameras swapped");
  EXPECT_EQ(error(replaced(kYaml, "image_width:", "fisheye_model: 1\nimage_width:")),
            "the left camera has 5 distortion coefficients, expected the 4 of a fisheye lens");
  EXPECT_EQ(read(replaced(kYaml, "image_width:", "fisheye_model: 0\nimage_width:")).format,
            "OpenCV");
  EXPECT_EQ(error(replaced(kKitti, "P1: 7.0e+02 0", "P1: 7.0e+02")),
            "P1 has 11 values, expected a 3x4 matrix");
  EXPECT_EQ(error(replaced(kKitti, "P1:", "P9:")), "there is no P1 in it, expected a 3x4 matrix");
  EXPECT_EQ(error(replaced(kKitti, "P0: 7.0e+02", "P0: 0")).substr(0, 23),
            "the left camera's fx is");
  const std::string missing = folder_ / "missing.yml";
  EXPECT_EQ(error_of([&] { read_stereo_calibration(missing); }),
            "cannot read " + missing + ": no such file");
}

TEST_F(CalibrationFiles, SizesOfImages) {
  const StereoCalibration calibration = read(kYaml);
  EXPECT_EQ(error_of([&] { calibration.check_image_size(640, 480); }), "");
  EXPECT_EQ(error_of([&] { calibration.check_image_size(1280, 960); }),
            "the images are 1280x960, but the calibration is for 640x480");
  EXPECT_EQ(error_of([&] { calibration.check_image_size(480, 640); }),
            "the images are 480x640, but the calibration is for 640x480 (`orientation` stored "
            "leaves images as files hold them)");
  const StereoCalibration kitti = read(kKitti);
  EXPECT_EQ(error_of([&] { kitti.check_image_size(1226, 370); }), "");
  EXPECT_EQ(error_of([&] { kitti.check_image_size(600, 370); }),
            "the left camera's principal point (600, 180) is outside of the 600x370 images: "
            "expected a calibration of images of this size");
  StereoCalibration normalised = calibration;
  normalised.image_size.reset();
  normalised.left.matrix << 0.83, 0, 0.5, 0, 1.1, 0.5, 0, 0, 1;
  EXPECT_EQ(error_of([&] { normalised.check_image_size(640, 480); }),
            "the left camera's fx is 0.83 pixels, expected at least 32 for 640x480 images");
}

// Cut anywhere, with bytes changed, repeated and removed: an Error of one line or a valid result.
TEST_F(CalibrationFiles, DamagedFilesEndInOneLine) {
  std::mt19937 random(5);
  int refused = 0;
  int accepted = 0;
  const auto attempt = [&](const std::string& text) {
    if (text.empty()) {
      return;
    }
    put_text(file_, text);
    try {
      read_stereo_calibration(file_).validate();
      ++accepted;
    } catch (const Error& error) {
      ++refused;
      const std::string what = error.what();
      ASSERT_EQ(what.rfind(file_ + ": ", 0), 0U) << what;
      for (const char c : what) {
        ASSERT_TRUE(c >= ' ' && c <= '~') << what;
      }
    }
  };
  for (const std::string text : {kYaml, kXml, kMiddlebury, kKitti, kKalibr, kJson, kOrbSlam}) {
    for (std::size_t size = 1; size < text.size(); size += 29) {
      attempt(text.substr(0, size));
    }
    for (int i = 0; i < 80; ++i) {
      std::string damaged = text;
      for (unsigned change = 0; change <= random() % 4; ++change) {
        const std::size_t at = random() % damaged.size();
        switch (random() % 4) {
          case 0:
            damaged[at] = static_cast<char>(random());
            break;
          case 1:
            damaged.erase(at, random() % 20);
            break;
          case 2:
            damaged.insert(at, damaged.substr(random() % damaged.size(), random() % 60));
            break;
          default:
            damaged[at] = "<>[]:-=;,\n e0"[random() % 13];
        }
      }
      attempt(damaged);
    }
  }
  EXPECT_GT(refused, 150);
  EXPECT_GT(accepted, 30);
  // Nesting as deep as one likes, and names and numbers as long.
  const std::string deep(100000, '[');
  const std::string names(100000, 'M');
  for (const std::string& text :
       {"M1: " + deep, "M1: " + std::string(100000, '-'), names + ":", "<" + names + ">",
        "<a>" + std::string(100000, '<'), std::string(300000, '1'), std::string(1000, '\0')}) {
    attempt(text);
  }
}

TEST(CalibrationFilesOfDataSets, AreRead) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::exists(data / "kitti_seq1" / "calib.txt")) {
    GTEST_SKIP() << "no data sets at " << data;
  }
  const StereoCalibration kitti = read_stereo_calibration(data / "kitti_seq1" / "calib.txt");
  EXPECT_NEAR(kitti.baseline(), 0.5372, 1e-4);
  EXPECT_NO_THROW(kitti.check_image_size(1226, 370));
  const StereoCalibration motorcycle = read_stereo_calibration(data / "motorcycle" / "calib.txt");
  EXPECT_NEAR(motorcycle.doffs_px(), 32.778, 1e-9);
  const StereoCalibration chessboard =
      read_stereo_calibration(data / "chessboard" / "stereo_reference.yml");
  EXPECT_NEAR(chessboard.baseline(), 0.0835, 1e-4);
  EXPECT_EQ(chessboard.left.distortion.size(), 5U);
  EXPECT_EQ(chessboard.image_size->width_px, 640);
  // Halves and lists of file names are not calibrations.
  EXPECT_NE(error_of([&] {
              read_stereo_calibration(data / "chessboard" / "intrinsics.yml");
            }).find("no R and T"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              read_stereo_calibration(data / "chessboard" / "stereo_calib.xml");
            }).find("no matrix of the left"),
            std::string::npos);
}

}  // namespace vantage::stereo_calibration_test
