#include "engine/rectification/board/board_calibration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/affine.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/order_statistics.h"
#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr int kMinPairs = 3;
/// In squares: corners in one row do not tell how a board lies.
constexpr double kMinArea = 2;
/// The residual must fall by this share for another coefficient.
constexpr double kWorthOfK3 = 0.05;
constexpr double kMaxResidual_px = 1;
constexpr double kMaxResidualRatio = 3;
/// Of the width: more than poses of single pictures are off.
constexpr double kMaxShareOff = 0.01;
const cv::TermCriteria kConverged(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9);

/// The corners that two cameras see, or one camera twice, as OpenCV takes them.
struct BoardViews {
  std::vector<std::size_t> pictures;
  std::vector<std::vector<cv::Point3f>> points_m;
  std::array<std::vector<std::vector<cv::Point2f>>, 2> seen;
};

BoardViews views_of(std::size_t one, std::size_t other, const CalibrationBoard& board,
                    const std::vector<BoardPicture>& pictures) {
  BoardViews views;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const BoardCorners& first = pictures[i].seen[one];
    const BoardCorners& second = pictures[i].seen[other];
    std::vector<cv::Point3f> points;
    std::vector<cv::Point2f> flat;
    std::array<std::vector<cv::Point2f>, 2> seen;
    for (std::size_t k = 0; k < first.numbers.size(); ++k) {
      const auto same = std::ranges::find(second.numbers, first.numbers[k]);
      if (same != second.numbers.end()) {
        const cv::Point2d at(board.corner_m(*same).x(), board.corner_m(*same).y());
        points.emplace_back(at.x, at.y, 0);
        flat.emplace_back(at);
        const auto l = static_cast<std::size_t>(same - second.numbers.begin());
        seen[0].emplace_back(first.positions_px[k].x(), first.positions_px[k].y());
        seen[1].emplace_back(second.positions_px[l].x(), second.positions_px[l].y());
      }
    }
    std::vector<cv::Point2f> outline;
    if (!flat.empty() && pictures[i].left_out.empty()) {
      cv::convexHull(flat, outline);
    }
    if (outline.size() > 2 &&
        cv::contourArea(outline) >= kMinArea * board.square_m * board.square_m) {
      views.pictures.push_back(i);
      views.points_m.push_back(std::move(points));
      views.seen[0].push_back(std::move(seen[0]));
      views.seen[1].push_back(std::move(seen[1]));
    }
  }
  return views;
}

/// A chessboard that looks the same upside down has two first corners: in the right picture the one
/// is taken that makes it lie as in the left one.
void turn_alike(const CalibrationBoard& board, BoardPicture& picture) {
  const auto across = [](const BoardCorners& seen) {
    return Eigen::Vector2d(seen.positions_px.back() - seen.positions_px.front());
  };
  auto& [left, right] = picture.seen;
  if (!board.has_markers() && (board.columns + board.rows) % 2 == 0 && !left.numbers.empty() &&
      !right.numbers.empty() && across(left).dot(across(right)) < 0) {
    std::ranges::reverse(right.positions_px);
  }
}

/// A camera, and what it says of its pictures.
struct BoardCamera {
  double rms_px = 0;
  cv::Mat matrix;
  cv::Mat distortion;
  std::vector<double> residuals_px;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> places;
};

BoardCamera fit_camera(const BoardViews& views, cv::Size size) {
  const auto fitted = [&](int fixed) {
    BoardCamera camera;
    camera.rms_px = cv::calibrateCamera(
        views.points_m, views.seen[0], size, camera.matrix, camera.distortion, camera.turns,
        camera.places, cv::noArray(), cv::noArray(), camera.residuals_px, fixed, kConverged);
    return camera;
  };
  BoardCamera few = fitted(cv::CALIB_FIX_K3);
  BoardCamera all = fitted(0);
  return all.rms_px < (1 - kWorthOfK3) * few.rms_px ? all : few;
}

/// Leaves out those of `which` whose residuals are above `limit_px` and several times the median;
/// false if none is.
bool leave_out(const std::vector<std::size_t>& which, const std::vector<double>& residuals_px,
               double limit_px, std::vector<BoardPicture>& pictures) {
  const double median_px = upper_median(std::vector(residuals_px));
  bool is_any = false;
  for (std::size_t k = 0; k < which.size(); ++k) {
    if (residuals_px[k] > std::max(limit_px, kMaxResidualRatio * median_px)) {
      pictures[which[k]].left_out =
          fmt::format("its corners are off by {:.1f} px, those of others by {:.2f}",
                      residuals_px[k], median_px);
      is_any = true;
    }
  }
  return is_any;
}

/// Leaves out pictures of two moments, which least squares would follow: most of their corners are
/// not where the left pictures and the pose that most of all agree on put them in the right ones.
bool leave_out_two_moments(const BoardViews& both, const std::vector<cv::Affine3d>& left_poses,
                           const BoardCamera& right, double tolerance_px,
                           std::vector<BoardPicture>& pictures) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> seen;
  for (std::size_t k = 0; k < both.pictures.size(); ++k) {
    for (const cv::Point3f& point : both.points_m[k]) {
      points.push_back(left_poses[both.pictures[k]] * cv::Point3d(point));
    }
    seen.insert(seen.end(), both.seen[1][k].begin(), both.seen[1][k].end());
  }
  cv::Mat turn;
  cv::Mat place;
  std::vector<int> agreeing;
  cv::solvePnPRansac(points, seen, right.matrix, right.distortion, turn, place, false, 200,
                     static_cast<float>(tolerance_px), 0.999, agreeing);
  bool is_any = false;
  std::ptrdiff_t first = 0;
  for (std::size_t k = 0; k < both.pictures.size(); ++k) {
    const auto count = static_cast<std::ptrdiff_t>(both.points_m[k].size());
    const auto agree = std::ranges::count_if(
        agreeing, [&](int corner) { return corner >= first && corner < first + count; });
    if (2 * agree < count) {
      pictures[both.pictures[k]].left_out = "its pictures are of two moments";
      is_any = true;
    }
    first += count;
  }
  return is_any;
}

Camera camera_of(const BoardCamera& fitted) {
  Camera camera;
  cv::cv2eigen(fitted.matrix, camera.matrix);
  camera.distortion.assign(fitted.distortion.begin<double>(), fitted.distortion.end<double>());
  return camera;
}

/// The cameras that the pictures agree on which are not left out; leaves out more, and then is to
/// be called again: false.
bool fit(const CalibrationBoard& board, cv::Size size, BoardCalibration& result) {
  const BoardViews both = views_of(0, 1, board, result.pictures);
  result.pairs = static_cast<int>(both.pictures.size());
  if (result.pairs < kMinPairs) {
    throw Error(
        fmt::format("{} of {} pairs show the board {} to both cameras, expected at least "
                    "{}, in different places and tilted; has it so many inner corners?",
                    result.pairs, result.pictures.size(), board.text, kMinPairs));
  }
  std::array<BoardCamera, 2> cameras;
  std::vector<cv::Affine3d> poses(result.pictures.size());  // in the frame of the left camera, last
  for (const std::size_t side : {1, 0}) {  // tilts are those that the left camera sees, if it does
    const BoardViews views = views_of(side, side, board, result.pictures);
    cameras[side] = fit_camera(views, size);
    if (leave_out(views.pictures, cameras[side].residuals_px, kMaxResidual_px, result.pictures)) {
      return false;
    }
    for (std::size_t k = 0; k < views.pictures.size(); ++k) {
      BoardPicture& picture = result.pictures[views.pictures[k]];
      cv::Affine3d& pose = poses[views.pictures[k]];
      pose = cv::Affine3d(cameras[side].turns[k], cameras[side].places[k]);
      picture.rms_px[side] = cameras[side].residuals_px[k];
      picture.tilt_degrees = degrees(std::acos(std::min(1.0, std::abs(pose.rotation()(2, 2)))));
    }
  }
  if (leave_out_two_moments(both, poses, cameras[1], kMaxShareOff * size.width, result.pictures)) {
    return false;
  }
  cv::Mat rotation;
  cv::Mat translation;
  cv::Mat residuals_px;
  result.rms_px = cv::stereoCalibrate(
      both.points_m, both.seen[0], both.seen[1], cameras[0].matrix, cameras[0].distortion,
      cameras[1].matrix, cameras[1].distortion, size, rotation, translation, cv::noArray(),
      cv::noArray(), residuals_px, cv::CALIB_FIX_INTRINSIC, kConverged);
  result.matches.clear();
  std::vector<double> worse_px;
  for (std::size_t k = 0; k < both.pictures.size(); ++k) {
    const int row = static_cast<int>(k);
    auto& rms_px = result.pictures[both.pictures[k]].rms_px;
    rms_px = {residuals_px.at<double>(row, 0), residuals_px.at<double>(row, 1)};
    worse_px.push_back(std::max(rms_px[0], rms_px[1]));
    std::ranges::transform(both.seen[0][k], both.seen[1][k], std::back_inserter(result.matches),
                           [](const cv::Point2f& left, const cv::Point2f& right) {
                             return PointMatch{{left.x, left.y}, {right.x, right.y}};
                           });
  }
  result.calibration.left = camera_of(cameras[0]);
  result.calibration.right = camera_of(cameras[1]);
  cv::cv2eigen(rotation, result.calibration.rotation);
  cv::cv2eigen(translation, result.calibration.translation);
  return !leave_out(both.pictures, worse_px, kMaxResidual_px, result.pictures);
}

}  // namespace

BoardCalibration calibrate_with_board(const CalibrationBoard& board,
                                      std::vector<BoardPicture> pictures, ImageSize size) {
  prepare_opencv();
  BoardCalibration result;
  result.pictures = std::move(pictures);
  for (BoardPicture& picture : result.pictures) {
    turn_alike(board, picture);
    if (picture.seen[0].numbers.empty() && picture.seen[1].numbers.empty()) {
      picture.left_out = "no board is found";
    }
  }
  try {
    while (!fit(board, {size.width_px, size.height_px}, result)) {
    }
  } catch (const cv::Exception&) {
    throw Error(
        fmt::format("no cameras agree with the pictures of the board {}, expected it in "
                    "different places and tilted",
                    board.text));
  }
  StereoCalibration& cameras = result.calibration;
  cameras.image_size = size;
  cameras.metres_per_unit = 1;
  cameras.format = "board " + board.text;
  cameras.validate();
  for (const BoardPicture& picture : result.pictures) {
    for (std::size_t side = 0; picture.left_out.empty() && side < 2; ++side) {
      for (const Eigen::Vector2d& at : picture.seen[side].positions_px) {
        const auto cell = [](double position, int pixels, int cells) {
          return std::clamp(static_cast<int>((position + 0.5) / pixels * cells), 0, cells - 1);
        };
        ++result.corners[side][static_cast<std::size_t>(
            cell(at.y(), size.height_px, BoardCalibration::kRows) * BoardCalibration::kColumns +
            cell(at.x(), size.width_px, BoardCalibration::kColumns))];
      }
    }
  }
  return result;
}

std::vector<PointMatch> rectified_matches(const std::vector<PointMatch>& matches,
                                          const StereoCalibration& calibration,
                                          const RectifiedPair& pair) {
  const LensModel left(calibration.left);
  const LensModel right(calibration.right);
  std::vector<PointMatch> moved;
  for (const PointMatch& match : matches) {
    const auto on_left = left.ray_of(match.left);
    const auto on_right = right.ray_of(match.right);
    if (on_left && on_right) {
      const Eigen::Matrix3d& of_left = calibration.left.matrix;
      const Eigen::Matrix3d& of_right = calibration.right.matrix;
      moved.push_back({(pair.left.homography * of_left * on_left->homogeneous()).hnormalized(),
                       (pair.right.homography * of_right * on_right->homogeneous()).hnormalized()});
    }
  }
  return moved;
}

}  // namespace vantage
