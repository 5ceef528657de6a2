#include <Eigen/Dense>
#include <cmath>

#include "engine/rectification/rotations.h"
#include "engine/rectification/stereo_calibration.h"
#include "tests/apps/pair_fixture.h"

namespace vantage::command_rectify_board_test {

constexpr int kColumns = 6;
constexpr int kRows = 5;
constexpr double kSquare_m = 0.025;
constexpr double kFocal_px = 300;
constexpr double kBaseline_m = 0.1;

/// A chessboard before one of two parallel cameras: `place` of its middle from the left one.
void write_board(const std::string& file, const Eigen::Vector3d& turn, Eigen::Vector3d place,
                 double camera_x_m) {
  Image<std::uint8_t> image(320, 240);
  place.x() -= camera_x_m;
  const Eigen::Matrix3d rotation = rotation_by(turn);
  Eigen::Matrix3d from_board;
  from_board << rotation.col(0), rotation.col(1), place;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> to_board = from_board.inverse();
  const double* const m = to_board.data();  // Eigen's objects are slow where nothing is optimised
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      int sum = 0;
      for (int sample = 0; sample < 9; ++sample) {
        const double u = (x + (sample % 3 - 1) / 3.0 - 159.5) / kFocal_px;
        const double v = (y + (sample / 3 - 1) / 3.0 - 119.5) / kFocal_px;
        const double scale = 1 / (kSquare_m * (m[6] * u + m[7] * v + m[8]));
        const double at_x = (m[0] * u + m[1] * v + m[2]) * scale;
        const double at_y = (m[3] * u + m[4] * v + m[5]) * scale;
        const auto column = static_cast<int>(std::floor(at_x + (kColumns + 1) / 2.0));
        const auto row = static_cast<int>(std::floor(at_y + (kRows + 1) / 2.0));
        const bool is_on_board = column >= 0 && row >= 0 && column <= kColumns && row <= kRows;
        sum += is_on_board && (column + row) % 2 == 0 ? 30 : 220;
      }
      image.at(x, y) = static_cast<std::uint8_t>(sum / 9);
    }
  }
  write_photograph(file, {std::move(image)});
}

TEST(RectifyBoard, PicturesOfABoardGiveCamerasInMetres) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "left");
  fs::create_directories(folder / "right");
  struct Pose {
    Eigen::Vector3d turn;
    Eigen::Vector3d place;
  };
  int count = 0;
  for (const Pose& pose :
       {Pose{{0.5, 0, 0}, {0.05, 0, 0.55}}, Pose{{-0.4, 0.2, 0.1}, {0.1, 0, 0.5}},
        Pose{{0, 0.5, 0}, {0.05, 0.06, 0.5}}, Pose{{0.1, -0.5, -0.1}, {0.08, -0.06, 0.55}}}) {
    const std::string name = "/b" + std::to_string(count++) + ".png";
    write_board(folder / ("left" + name), pose.turn, pose.place, 0);
    write_board(folder / ("right" + name), pose.turn, pose.place, kBaseline_m);
  }
  write_grey(folder / "left/b9.png", 320, 240, 100);
  write_grey(folder / "right/b9.png", 320, 240, 100);
  const std::string rig = folder / "rig.yml";
  const std::string report = folder / "report.json";
  const ProcessResult result =
      succeeds(run_vantage({"rectify", folder / "left", folder / "right", "--board", "6x5:25mm",
                            "--matrices", rig, "--report", report}));
  EXPECT_THAT(result.err, HasSubstr("b0.png: corners off by"));
  EXPECT_THAT(result.err, HasSubstr("b9.png: no board is found"));
  EXPECT_THAT(result.err, HasSubstr("cameras from 4 pairs"));
  EXPECT_THAT(result.err, HasSubstr("photograph next: no board in the upper left"));
  EXPECT_THAT(result.err, HasSubstr("only 4 pairs"));

  const StereoCalibration cameras = read_stereo_calibration(rig);
  EXPECT_NEAR(cameras.baseline() * cameras.metres_per_unit.value_or(0), kBaseline_m, 0.002);
  EXPECT_NEAR(cameras.left.matrix(0, 0), kFocal_px, 4);
  EXPECT_TRUE(cameras.has_scale);
  const auto results = read_json(report)["results"];
  EXPECT_LT(results["vertical_error"]["rms_px"].get<double>(), 0.25);
  EXPECT_NEAR(results["baseline_m"].get<double>(), kBaseline_m, 0.002);
  const auto& board = results["board"];
  EXPECT_EQ(board["pairs"], 4);
  EXPECT_EQ(board["pictures"].size(), 5U);
  EXPECT_LT(board["pictures"][0]["left_rms_px"].get<double>(), 0.3);
  EXPECT_EQ(board["pictures"][4]["left_out"], "no board is found");
  EXPECT_GT(board["left_covered_share"].get<double>(), 0.1);

  const std::string left = folder / "left/b9.png";
  const std::string right = folder / "right/b9.png";
  const auto refusal = [&](const Words& more) {
    return run_vantage(joined({"rectify", left, right, "--matrices", folder / "x.yml"}, more)).err;
  };
  EXPECT_THAT(refusal({"--board", "6x5:25mm"}), HasSubstr("0 of 1 pairs show the board 6x5:25mm"));
  EXPECT_THAT(refusal({"--board", "6x5:25"}), HasSubstr("'25' is not a length with its unit"));
  EXPECT_THAT(refusal({"--board", "6x5:25mm", "--calibration", rig}),
              HasSubstr("--calibration has no effect with --board"));
  EXPECT_FALSE(fs::exists(folder / "x.yml"));
}

}  // namespace vantage::command_rectify_board_test
