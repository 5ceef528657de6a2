#include "engine/view_geometry/intrinsics_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/text_lines.h"
#include "engine/rectification/calibration_entries.h"
#include "engine/rectification/rotations.h"
#include "engine/view_geometry/colmap_model.h"

namespace vantage {
namespace {

constexpr std::array kPoseNames = {std::string_view("extrinsic_parameters"),
                                   std::string_view("Extrinsic_Parameters")};

bool is_xml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && text[first] == '<';
}

CalibrationEntries entries_of(std::string_view text) {
  return is_xml(text) ? xml_entries(text) : yaml_entries(text);
}

/// The first of these entries that exists; null if none does.
const CalibrationEntry* find(const CalibrationEntries& entries,
                             std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto found = entries.find(name);
    if (found != entries.end()) {
      return &found->second;
    }
  }
  return nullptr;
}

std::vector<double> values_of(const CalibrationEntry& entry, std::string_view name,
                              std::size_t count, const std::string& file) {
  if (!entry.problem.empty()) {
    throw Error(fmt::format("{}: {} {}", file, name, entry.problem));
  }
  if (count != 0 && entry.values.size() != count) {
    throw Error(
        fmt::format("{}: {} has {} values, expected {}", file, name, entry.values.size(), count));
  }
  return entry.values;
}

void refuse_fisheyes(const CalibrationEntries& entries, const std::string& file) {
  const CalibrationEntry* model = find(entries, {"distortion_model", "camera_model", "model"});
  if (model != nullptr && (model->word == "fisheye" || model->word == "equidistant" ||
                           model->word == "kannala_brandt" || model->word == "KANNALA_BRANDT")) {
    throw Error(
        fmt::format("{}: is of a fisheye lens, expected OpenCV's standard model "
                    "(k1 k2 p1 p2 ...)",
                    file));
  }
}

int side_of(double value, const std::string& file) {
  if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
    throw Error(fmt::format("{}: the image size holds {}, expected whole pixels", file, value));
  }
  return static_cast<int>(value);
}

ImageSize size_of(const CalibrationEntries& entries, const std::string& file) {
  const CalibrationEntry* width = find(entries, {"image_width"});
  const CalibrationEntry* height = find(entries, {"image_height"});
  if (width != nullptr && height != nullptr) {
    return {side_of(values_of(*width, "image_width", 1, file)[0], file),
            side_of(values_of(*height, "image_height", 1, file)[0], file)};
  }
  if (const CalibrationEntry* size = find(entries, {"image_size", "imageSize"})) {
    const std::vector<double> sides = values_of(*size, "image_size", 2, file);
    return {side_of(sides[0], file), side_of(sides[1], file)};
  }
  return {};
}

Eigen::Matrix3d matrix_of(const std::vector<double>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// The left 3×3 part of a projection P = K (I | t).
Eigen::Matrix3d matrix_of_projection(const std::vector<double>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows.data()).leftCols<3>();
}

/// The numbers of a text that holds nothing else; none for any other text.
std::vector<double> numbers_alone(std::string_view text, const std::string& file) {
  TextLines lines(text, file);
  std::vector<double> numbers;
  while (const auto line = lines.next_with_words()) {
    for (const std::string_view word : words_of(*line)) {
      const std::optional<double> number = finite_number(word);
      if (!number) {
        return {};
      }
      numbers.push_back(*number);
    }
  }
  return numbers;
}

/// From a file without names.
std::optional<SizedCamera> camera_of_numbers(const std::vector<double>& numbers, int kitti_camera) {
  SizedCamera sized;
  Camera& camera = sized.camera;
  if (numbers.size() == 4 || numbers.size() == 8 || numbers.size() == 9) {
    camera.matrix << numbers[0], 0, numbers[2], 0, numbers[1], numbers[3], 0, 0, 1;
    camera.distortion.assign(numbers.begin() + 4, numbers.end());
    return sized;
  }
  if (!numbers.empty() && numbers.size() % 12 == 0) {
    // Two lines are one of the pairs 0, 1 and 2, 3.
    const std::size_t lines = numbers.size() / 12;
    const auto line = static_cast<std::size_t>(lines == 2 ? kitti_camera % 2 : kitti_camera);
    const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(line < lines ? 12 * line : 0);
    camera.matrix = matrix_of_projection({first, first + 12});
    return sized;
  }
  return std::nullopt;
}

bool looks_like_colmap(std::string_view text, const std::string& file) {
  TextLines lines(text, file);
  const auto line = lines.next_with_words();
  const auto words = line ? words_of(*line) : std::vector<std::string_view>{};
  return words.size() >= 4 && finite_number(words[0]) && words[1].front() >= 'A' &&
         words[1].front() <= 'Z';
}

SizedCamera camera_of_colmap(std::string_view text, const std::string& file) {
  const std::map<long long, SizedCamera> cameras = parse_colmap_cameras(text, file);
  if (cameras.size() != 1) {
    throw Error(fmt::format("{}: holds {} cameras, expected one", file, cameras.size()));
  }
  return cameras.begin()->second;
}

/// A projection P of a file of KITTI's; null for other files.
const CalibrationEntry* projection_of(const CalibrationEntries& entries, int kitti_camera) {
  for (const int camera : {kitti_camera, 0, 1, 2, 3}) {
    const std::string name = fmt::format("P{}", camera);
    const std::string raw_name = fmt::format("P_rect_0{}", camera);
    if (const CalibrationEntry* projection = find(entries, {name, raw_name})) {
      return projection;
    }
  }
  return nullptr;
}

SizedCamera camera_of_entries(const CalibrationEntries& entries, const std::string& file,
                              int kitti_camera) {
  refuse_fisheyes(entries, file);
  SizedCamera sized;
  const CalibrationEntry* matrix = find(entries, {"camera_matrix", "Camera_Matrix", "cameraMatrix",
                                                  "K", "K1", "M1", "cameraMatrix1"});
  const CalibrationEntry* projection = projection_of(entries, kitti_camera);
  if (projection != nullptr && matrix == nullptr) {
    sized.camera.matrix = matrix_of_projection(values_of(*projection, "P", 12, file));
    return sized;
  }
  if (matrix == nullptr) {
    throw Error(
        fmt::format("{}: holds no camera_matrix (or K), expected OpenCV's YAML or XML, "
                    "calib.txt of KITTI, cameras.txt of COLMAP, or fx fy cx cy",
                    file));
  }
  sized.camera.matrix = matrix_of(values_of(*matrix, "camera_matrix", 9, file));
  if (const CalibrationEntry* distortion =
          find(entries, {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D",
                         "D1", "distCoeffs1"})) {
    sized.camera.distortion = values_of(*distortion, "distortion_coefficients", 0, file);
  }
  sized.size = size_of(entries, file);
  return sized;
}

}  // namespace

SizedCamera parse_intrinsics(std::string_view text, const std::string& file, int kitti_camera) {
  SizedCamera sized;
  if (is_xml(text)) {
    sized = camera_of_entries(xml_entries(text), file, kitti_camera);
  } else if (const auto camera = camera_of_numbers(numbers_alone(text, file), kitti_camera)) {
    sized = *camera;
  } else if (looks_like_colmap(text, file)) {
    sized = camera_of_colmap(text, file);
  } else {
    sized = camera_of_entries(yaml_entries(text), file, kitti_camera);
  }
  try {
    sized.camera.validate("camera");
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
  return sized;
}

SizedCamera read_intrinsics(const std::filesystem::path& file, int kitti_camera) {
  return parse_intrinsics(read_file_text(file), file.string(), kitti_camera);
}

bool has_opencv_poses(std::string_view text) {
  const CalibrationEntries entries = entries_of(text);
  return find(entries, {kPoseNames[0], kPoseNames[1]}) != nullptr;
}

std::vector<CameraPose> parse_opencv_poses(std::string_view text, const std::string& file) {
  constexpr std::size_t kNumbers = 6;
  const CalibrationEntries entries = entries_of(text);
  const CalibrationEntry* entry = find(entries, {kPoseNames[0], kPoseNames[1]});
  if (entry == nullptr) {
    throw Error(
        fmt::format("{}: holds no {}, expected poses as rows of six numbers", file, kPoseNames[0]));
  }
  const std::vector<double> values = values_of(*entry, kPoseNames[0], 0, file);
  if (values.size() % kNumbers != 0) {
    throw Error(
        fmt::format("{}: {} has {} values, expected rows of six (rotation vector, "
                    "translation)",
                    file, kPoseNames[0], values.size()));
  }
  std::vector<CameraPose> poses;
  for (std::size_t i = 0; i < values.size(); i += kNumbers) {
    poses.push_back({.rotation = rotation_by({values[i], values[i + 1], values[i + 2]}),
                     .translation = {values[i + 3], values[i + 4], values[i + 5]}});
  }
  return poses;
}

}  // namespace vantage
