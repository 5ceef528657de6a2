// Calibrations, intrinsics and camera models of other programs.
#include "engine/error.h"
#include "engine/rectification/board/calibration_board.h"
#include "engine/rectification/calibration/posed_images.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/view_geometry/intrinsics_file.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

/// What is read is valid; whether it fits images, their owner is told.
void use(const StereoCalibration& calibration) {
  calibration.validate();
  try {
    calibration.for_images(640, 480).check_image_size(640, 480);
  } catch (const Error&) {
  }
}

/// One file, or, divided by a zero byte, one of each camera.
void read_calibration(Bytes bytes) {
  const auto [first, second] = halves_of(bytes);
  std::string name = file_of(first);
  if (!second.empty()) {
    name += "," + file_of(second, "input2").string();
  }
  use(read_stereo_calibration(name));
  use(read_rectified_calibration(name, {.kitti_cameras = {}, .lens = LensKind::kFisheye}));
}

void read_one_camera(Bytes bytes) {
  const std::string text = text_of(bytes);
  if (has_opencv_poses(text, "input")) {
    (void)parse_opencv_poses(text, "input");
  }
  (void)parse_intrinsics(text, "input", {.kitti_camera = 2}).scaled_to({320, 240});
}

/// cameras.txt and images.txt of COLMAP, divided by a zero byte.
void read_model(Bytes bytes) {
  const auto [cameras, images] = halves_of(bytes);
  (void)parse_colmap_images(text_of(images), "input images.txt",
                            parse_colmap_cameras(text_of(cameras), "input cameras.txt"));
}

void read_board(Bytes bytes) { (void)parse_board(text_of(bytes)); }

const Registration kCalibration("calibration", read_calibration);
const Registration kIntrinsics("intrinsics", read_one_camera);
const Registration kColmap("colmap", read_model);
const Registration kBoard("board", read_board, false);

}  // namespace
}  // namespace vantage::fuzz
