#include "engine/rectification/board/board_calibration.h"

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>

#include "engine/io/images/photograph_io.h"
#include "engine/rectification/rotations.h"
#include "engine/rectification/vertical_error.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::board_calibration_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;
constexpr int kSamples = 2;  // per pixel and axis

/// Grey level of a place on the board, in squares from the first inner corner.
using Print = std::function<double(double x, double y)>;

double chessboard(const CalibrationBoard& board, double x, double y) {
  const bool is_on_board = x >= -1 && y >= -1 && x < board.columns && y < board.rows;
  const int sum = static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y));
  return is_on_board && sum % 2 == 0 ? 30 : 220;
}

/// A rig whose pictures OpenCV's model of lenses makes, not ours.
class BoardCalibrationTest : public testing::Test {
 protected:
  BoardCalibrationTest() {
    truth_.left.matrix << 300, 0, 165, 0, 302, 118, 0, 0, 1;
    truth_.right.matrix << 295, 0, 155, 0, 297, 122, 0, 0, 1;
    truth_.left.distortion = {-0.2, 0.06, 0.001, -0.001};
    truth_.right.distortion = {-0.18, 0.04, -0.001, 0.0005};
    truth_.rotation = rotation_by({0.01, 0.05, -0.02});
    truth_.translation = {-0.1, 0.002, 0.004};
    rays_ = {rays_of(truth_.left), rays_of(truth_.right)};
  }

  /// Of all samples, row by row.
  static std::vector<cv::Point2d> rays_of(const Camera& camera) {
    std::vector<cv::Point2d> pixels;
    for (int y = 0; y < kHeight_px * kSamples; ++y) {
      for (int x = 0; x < kWidth_px * kSamples; ++x) {
        pixels.emplace_back((x + 0.5) / kSamples - 0.5, (y + 0.5) / kSamples - 0.5);
      }
    }
    std::vector<cv::Point2d> rays;
    const cv::Matx33d matrix(camera.matrix(0, 0), 0, camera.matrix(0, 2), 0, camera.matrix(1, 1),
                             camera.matrix(1, 2), 0, 0, 1);
    cv::undistortPoints(pixels, rays, matrix, camera.distortion);
    return rays;
  }

  /// `turn` and `place` of the board's middle in the frame of the left camera, metres.
  [[nodiscard]] Photograph picture(const CalibrationBoard& board, const Print& print, Side side,
                                   const Eigen::Vector3d& turn,
                                   const Eigen::Vector3d& place) const {
    const std::vector<cv::Point2d>& rays = rays_[side == Side::kLeft ? 0 : 1];
    Eigen::Matrix3d rotation = rotation_by(turn);
    const Eigen::Vector3d middle((board.columns - 1) / 2.0, (board.rows - 1) / 2.0, 0);
    Eigen::Vector3d origin = place - rotation * middle * board.square_m;
    if (side == Side::kRight) {
      origin = truth_.rotation * origin + truth_.translation;
      rotation = truth_.rotation * rotation;
    }
    Eigen::Matrix3d board_to_ray;
    board_to_ray << rotation.col(0) * board.square_m, rotation.col(1) * board.square_m, origin;
    const Eigen::Matrix3d to_board = board_to_ray.inverse();
    Image<std::uint8_t> image(kWidth_px, kHeight_px);
    for (int y = 0; y < kHeight_px; ++y) {
      for (int x = 0; x < kWidth_px; ++x) {
        double sum = 0;
        for (int sample = 0; sample < kSamples * kSamples; ++sample) {
          const int row = y * kSamples + sample / kSamples;
          const cv::Point2d& ray = rays[static_cast<std::size_t>(row * kWidth_px * kSamples +
                                                                 x * kSamples + sample % kSamples)];
          const Eigen::Vector2d at = (to_board * Eigen::Vector3d(ray.x, ray.y, 1)).hnormalized();
          sum += print(at.x(), at.y());
        }
        image.at(x, y) = static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples)));
      }
    }
    return {std::move(image)};
  }

  [[nodiscard]] std::vector<BoardPicture> pictures(const CalibrationBoard& board,
                                                   const Print& print) const {
    struct Pose {
      Eigen::Vector3d turn;
      Eigen::Vector3d place;
    };
    std::vector<BoardPicture> taken;
    for (const Pose& pose :
         {Pose{{0.5, 0, 0}, {0, 0, 0.55}}, Pose{{-0.4, 0.2, 0.1}, {0.1, 0, 0.5}},
          Pose{{0, 0.5, 0}, {0.05, 0.06, 0.5}}, Pose{{0.1, -0.5, -0.1}, {0.08, -0.06, 0.55}},
          Pose{{0.3, 0.3, 0.2}, {0, 0.05, 0.45}}}) {
      BoardPicture one{.name = std::to_string(taken.size())};
      for (const Side side : {Side::kLeft, Side::kRight}) {
        one.seen[side == Side::kLeft ? 0 : 1] =
            find_board(picture(board, print, side, pose.turn, pose.place), board);
      }
      taken.push_back(std::move(one));
    }
    return taken;
  }

  void expect_truth(const BoardCalibration& found) const {
    const StereoCalibration& cameras = found.calibration;
    EXPECT_LT(found.rms_px, 0.25);
    EXPECT_NEAR(cameras.left.matrix(0, 0), 300, 5);
    EXPECT_NEAR(cameras.right.matrix(1, 1), 297, 5);
    EXPECT_NEAR(cameras.left.matrix(0, 2), 165, 5);
    EXPECT_NEAR(cameras.left.distortion[0], -0.2, 0.04);
    EXPECT_NEAR(cameras.baseline(), truth_.translation.norm(), 0.001);
    EXPECT_LT(degrees(rotation_vector(cameras.rotation * truth_.rotation.transpose()).norm()), 0.6);
    EXPECT_EQ(cameras.metres_per_unit, 1);
    // What counts is that corners of one point are in one row.
    const auto moved =
        rectified_matches(found.matches, cameras, rectified_pair(cameras, kWidth_px, kHeight_px));
    ASSERT_EQ(moved.size(), found.matches.size());
    const auto error = vertical_error(moved);
    ASSERT_TRUE(error);
    EXPECT_LT(error->rms_px, 0.3);
    EXPECT_GT(error->min_disparity_px, 0);
  }

  StereoCalibration truth_;
  std::array<std::vector<cv::Point2d>, 2> rays_;
};

TEST_F(BoardCalibrationTest, ChessboardsShowTheCameras) {
  const CalibrationBoard board = parse_board("6x5:50mm");
  std::vector<BoardPicture> taken =
      pictures(board, [&](double x, double y) { return chessboard(board, x, y); });
  BoardPicture none{.name = "none"};
  BoardPicture later = taken[1];  // the right picture is of another moment
  later.name = "later";
  later.seen[1] = taken[3].seen[1];
  BoardPicture one_side = taken[2];
  one_side.seen[1] = {};
  taken.insert(taken.end(), {none, later, one_side});
  const BoardCalibration found = calibrate_with_board(board, taken, {kWidth_px, kHeight_px});
  expect_truth(found);
  EXPECT_EQ(found.pairs, 5);
  EXPECT_EQ(found.matches.size(), 5U * 30);
  ASSERT_EQ(found.pictures.size(), 8U);
  EXPECT_THAT(found.pictures[0].left_out, IsEmpty());
  EXPECT_THAT(found.pictures[5].left_out, HasSubstr("no board"));
  EXPECT_THAT(found.pictures[6].left_out, HasSubstr("two moments"));
  EXPECT_THAT(found.pictures[7].left_out, IsEmpty());
  EXPECT_NEAR(found.pictures[0].tilt_degrees, degrees(0.5), 2);
  EXPECT_GT(found.covered_share(0), 0.2);
  EXPECT_LT(found.covered_share(1), 0.9);
}

TEST_F(BoardCalibrationTest, BoardsWithMarkersAreReadInParts) {
  const CalibrationBoard board = parse_board("7x6:50mm:36mm:DICT_4X4_50");
  EXPECT_EQ(board.columns, 6);
  constexpr int kSquare_px = 42;
  cv::Mat printed;
  cv::aruco::CharucoBoard::create(7, 6, 0.05F, 0.036F,
                                  cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50))
      ->draw({7 * kSquare_px, 6 * kSquare_px}, printed);
  const Print print = [&](double x, double y) {
    const auto column = static_cast<int>(std::floor((x + 1) * kSquare_px));
    const auto row = static_cast<int>(std::floor((y + 1) * kSquare_px));
    return column >= 0 && row >= 0 && column < printed.cols && row < printed.rows
               ? 30 + 190 / 255.0 * printed.at<std::uint8_t>(row, column)
               : 220;
  };
  expect_truth(calibrate_with_board(board, pictures(board, print), {kWidth_px, kHeight_px}));
  // Half of the board is outside.
  const BoardCorners part =
      find_board(picture(board, print, Side::kLeft, {0, 0, 0}, {-0.3, 0, 0.5}), board);
  EXPECT_GT(part.numbers.size(), 8U);
  EXPECT_LT(part.numbers.size(), 26U);
}

TEST_F(BoardCalibrationTest, OpenCvsPicturesAgreeWithOpenCvsCalibration) {
  const std::filesystem::path folder = test_paths::shared_data("chessboard");
  if (folder.empty()) {
    GTEST_SKIP() << "no pictures of a chessboard beside this checkout";
  }
  const CalibrationBoard board = parse_board("9x6:25mm");
  std::vector<BoardPicture> taken;
  for (const char* number : {"01", "03", "04", "06", "08", "13"}) {
    const auto corners = [&](const char* side) {
      return find_board(read_photograph(folder / (std::string(side) + number + ".jpg")), board);
    };
    taken.push_back({.name = number, .seen = {corners("left"), corners("right")}});
  }
  const BoardCalibration found = calibrate_with_board(board, taken, {640, 480});
  EXPECT_EQ(found.pairs, 6);
  EXPECT_LT(found.rms_px, 0.4);
  EXPECT_NEAR(found.calibration.baseline(), 0.0835, 0.001);
  EXPECT_NEAR(found.calibration.left.matrix(0, 0), 535.7, 6);
}

TEST(BoardAdvice, NamesWhatIsMissing) {
  BoardCalibration board;
  board.pairs = 12;
  board.corners[0].fill(1);
  board.corners[1].fill(1);
  for (int k = 0; k < 12; ++k) {
    board.pictures.push_back({.tilt_degrees = k % 2 == 0 ? 30.0 : 5.0});
  }
  EXPECT_THAT(board.advice(), IsEmpty());
  for (const int cell : {6, 7, 14, 15}) {
    board.corners[0][static_cast<std::size_t>(cell)] = 0;
  }
  board.corners[0][5] = 0;
  board.corners[0][13] = 0;
  EXPECT_THAT(board.advice(), ElementsAre("no board in the upper right of the left picture"));
  board.corners[0].fill(1);
  for (BoardPicture& picture : board.pictures) {
    picture.tilt_degrees = 10;
  }
  board.pairs = 4;
  EXPECT_THAT(board.advice(), ElementsAre(HasSubstr("none tilted more than 15 degrees"),
                                          HasSubstr("only 4 pairs")));
}

TEST(BoardText, IsReadOrRefused) {
  EXPECT_NEAR(parse_board("9x6:2.5cm").square_m, 0.025, 1e-12);
  EXPECT_FALSE(parse_board("9x6:1in").has_markers());
  EXPECT_EQ(parse_board("8x5:40mm:30mm:apriltag_36h11").dictionary, 20);
  for (const char* bad : {"", "9x6", "9x6:25", "9:25mm", "2x6:25mm", "9x6:25mm:20mm", "9x6:0mm",
                          "9x6:25mm:30mm:4x4_50", "9x6:25mm:20mm:4x4", "x6:25mm", "9x6x:25mm"}) {
    EXPECT_THAT(error_of([&] { (void)parse_board(bad); }), HasSubstr("9x6:25mm")) << bad;
  }
  EXPECT_THAT(error_of([&] {
                (void)calibrate_with_board(parse_board("9x6:25mm"), {{}, {}}, {640, 480});
              }),
              HasSubstr("0 of 2 pairs show the board 9x6:25mm"));
}

}  // namespace vantage::board_calibration_test
