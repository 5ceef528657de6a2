#include "engine/view_geometry/intrinsics_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/text_lines.h"
#include "engine/rectification/calibration/camera_reading.h"
#include "engine/rectification/calibration/posed_images.h"
#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr std::array kPoseNames = {std::string_view("extrinsic_parameters"),
                                   std::string_view("Extrinsic_Parameters")};

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

SizedCamera camera_of_entries(const CalibrationNames& names, const std::string& file,
                              const IntrinsicsChoice& choice) {
  CameraReading reading = read_camera(names, CameraLabel::kNone);
  SizedCamera sized;
  const CalibrationEntry* projection = projection_of(names.entries(), choice.kitti_camera);
  if (!reading.matrix && projection != nullptr && names.entries().count("M1") == 0) {
    sized.camera.matrix = matrix_of_projection(values_of(*projection, "P", 12, file));
    return sized;
  }
  if (!reading.matrix) {
    reading = read_camera(names, CameraLabel::kFirst);
  }
  if (!reading.matrix) {
    throw Error(
        fmt::format("there is no camera matrix: {}; or calib.txt of KITTI, cameras.txt of "
                    "COLMAP, or fx fy cx cy",
                    names.found_and_taken()));
  }
  look_at_unknown_distortion(names, {&reading, 1}, file, sized.remarks);
  choose_lenses({&reading, 1}, choice.lens, file, sized.remarks);
  sized.camera = reading.camera();
  sized.size = reading.size.value_or(ImageSize());
  return sized;
}

CalibrationEntries entries_in(std::string_view text, const std::string& file) {
  try {
    return entries_of(text);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace

SizedCamera parse_intrinsics(std::string_view text, const std::string& file,
                             const IntrinsicsChoice& choice) {
  auto known = camera_of_numbers(numbers_alone(text, file), choice.kitti_camera);
  if (!known && looks_like_colmap(text, file)) {
    known = camera_of_colmap(text, file);
  }
  SizedCamera sized;
  try {
    sized = known ? *known : camera_of_entries(CalibrationNames(entries_of(text)), file, choice);
    sized.camera.validate("camera");
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
  return sized;
}

SizedCamera read_intrinsics(const std::filesystem::path& file, const IntrinsicsChoice& choice) {
  return parse_intrinsics(read_file_text(file), file.string(), choice);
}

bool has_opencv_poses(std::string_view text, const std::string& file) {
  const CalibrationEntries entries = entries_in(text, file);
  return find(entries, {kPoseNames[0], kPoseNames[1]}) != nullptr;
}

std::vector<CameraPose> parse_opencv_poses(std::string_view text, const std::string& file) {
  constexpr std::size_t kNumbers = 6;
  const CalibrationEntries entries = entries_in(text, file);
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
