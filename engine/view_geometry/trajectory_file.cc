#include "engine/view_geometry/trajectory_file.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/text_lines.h"
#include "engine/view_geometry/nerf_transforms.h"

namespace vantage {
namespace {

constexpr std::size_t kTumNumbers = 8;
constexpr std::size_t kEurocNumbers = 17;
constexpr double kFirstNanoseconds = 1e14;  // as seconds, 3 million years
constexpr std::size_t kKittiNumbers = 12;
constexpr std::size_t kWholeMatrixNumbers = 16;
constexpr double kFarthest = 1e9;  // points of world coordinates are floats

/// `w_at`: where the quaternion's w is among the numbers.
CameraPose pose_of_tum(const std::vector<double>& numbers, std::size_t w_at,
                       const TextLines& lines) {
  const std::size_t x_at = w_at == 4 ? 5 : 4;
  const auto rotation =
      rotation_of_quaternion({numbers[w_at], numbers[x_at], numbers[x_at + 1], numbers[x_at + 2]});
  if (!rotation) {
    lines.fail(fmt::format("the quaternion does not have length 1, expected time tx ty tz {}",
                           w_at == 4 ? "qw qx qy qz" : "qx qy qz qw"));
  }
  return CameraPose::from_camera_to_world(*rotation, {numbers[1], numbers[2], numbers[3]});
}

CameraPose pose_of_kitti(const std::vector<double>& numbers, const TextLines& lines) {
  using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const Eigen::Map<const Matrix34> matrix(numbers.data());
  const auto rotation = nearest_rotation(matrix.leftCols<3>());
  if (!rotation) {
    lines.fail("the matrix does not start with a rotation, expected rows (R | t) of 3x4 numbers");
  }
  constexpr std::array<double, 4> kLastRow = {0, 0, 0, 1};
  for (std::size_t i = kKittiNumbers; i < numbers.size(); ++i) {
    if (numbers[i] != kLastRow[i - kKittiNumbers]) {
      lines.fail("the last row of the 4x4 matrix is not 0 0 0 1");
    }
  }
  return CameraPose::from_camera_to_world(*rotation, matrix.col(3));
}

}  // namespace

Trajectory Trajectory::of_camera(const CameraPose& camera_from_body) const {
  Trajectory result = *this;
  result.is_of_body = false;
  for (CameraPose& pose : result.poses) {
    pose = {
        .rotation = camera_from_body.rotation * pose.rotation,
        .translation = camera_from_body.rotation * pose.translation + camera_from_body.translation};
  }
  return result;
}

Trajectory parse_trajectory(std::string_view text, const std::string& file) {
  if (is_nerf_transforms(text)) {
    Trajectory trajectory{.format = "NeRF", .poses = {}, .times_s = {}};
    for (const PosedImage& image : parse_nerf_transforms(text, file)) {
      trajectory.poses.push_back(image.pose);
    }
    return trajectory;
  }
  TextLines lines(text, file);
  Trajectory trajectory;
  std::size_t expected = 0;
  std::vector<double> numbers;
  while (const auto line = lines.next_with_words()) {
    const std::vector<std::string_view> words = words_of(*line);
    if (expected == 0 && words.size() != kTumNumbers && words.size() != kKittiNumbers &&
        words.size() != kWholeMatrixNumbers && words.size() != kEurocNumbers) {
      lines.fail(
          fmt::format("holds {} values, expected 8 (TUM), 12 (KITTI) or 17 (EuRoC)", words.size()));
    }
    if (expected != 0 && words.size() != expected) {
      lines.fail(
          fmt::format("holds {} values, expected {} as the first pose", words.size(), expected));
    }
    expected = words.size();
    numbers.clear();
    for (const std::string_view word : words) {
      numbers.push_back(lines.number(word, fmt::format("value {}", numbers.size() + 1)));
    }
    const bool has_nanoseconds = numbers[0] >= kFirstNanoseconds;
    trajectory.is_of_body =
        expected == kEurocNumbers ||
        (expected == kTumNumbers && has_nanoseconds && line->find(',') != std::string_view::npos);
    const bool is_tum = trajectory.is_of_body || expected == kTumNumbers;
    trajectory.format = trajectory.is_of_body ? "EuRoC" : is_tum ? "TUM" : "KITTI";
    trajectory.poses.push_back(is_tum ? pose_of_tum(numbers, trajectory.is_of_body ? 4 : 7, lines)
                                      : pose_of_kitti(numbers, lines));
    if (const double farthest = trajectory.poses.back().centre().cwiseAbs().maxCoeff();
        !(farthest <= kFarthest)) {
      lines.fail(fmt::format("the position has a coordinate of {:.3g}, expected numbers within ±{}",
                             farthest, kFarthest));
    }
    if (is_tum) {
      trajectory.times_s.push_back(has_nanoseconds ? numbers[0] * 1e-9 : numbers[0]);
    }
  }
  if (trajectory.poses.empty()) {
    throw Error(fmt::format(
        "{}: holds no poses, expected lines of 8 (TUM), 12 (KITTI) or 17 (EuRoC) numbers", file));
  }
  return trajectory;
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  return parse_trajectory(read_file_text(file), file.string());
}

}  // namespace vantage
