#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/rectification/calibration/projection_files.h"
#include "engine/rectification/calibration/stereo_reading.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = 16U << 20;

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() > kMaxBytes) {
    throw Error(
        fmt::format("it has {} bytes, expected a text of at most {}", bytes.size(), kMaxBytes));
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

CalibrationEntries entries_of_file(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  try {
    return entries_of(text_of(bytes));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path.string(), error.what()));
  }
}

StereoCalibration parse(std::string_view text, CameraChoice cameras,
                        const CalibrationChoice& choice, const std::string& file) {
  if (const CalibrationEntries entries = assignment_entries(text); entries.contains("cam0")) {
    return from_middlebury(entries);
  }
  if (const CalibrationEntries entries = nameless_projections(text); !entries.empty()) {
    return from_kitti(entries, choice.kitti_cameras);
  }
  CalibrationEntries entries = entries_of(text);
  if (are_of_kitti(entries)) {
    return from_kitti(entries, choice.kitti_cameras);
  }
  const CalibrationNames names(std::move(entries));
  return are_of_one_camera(names) ? from_right_camera(names, cameras)
                                  : from_names(names, cameras, choice, file);
}

StereoCalibration parse_two(const std::vector<fs::path>& files, CameraChoice cameras,
                            const CalibrationChoice& choice, const std::string& file) {
  CalibrationEntries first = entries_of_file(files[0]);
  CalibrationEntries second = entries_of_file(files[1]);
  const std::array names = {CalibrationNames(first), CalibrationNames(second)};
  if (are_of_one_camera(names[0]) && are_of_one_camera(names[1])) {
    return from_two_cameras(names, cameras, choice, file);
  }
  first.merge(second);
  return from_names(CalibrationNames(std::move(first)), cameras, choice, file);
}

/// The file of the other camera, by its name, if there is one, and whether it is the first one.
std::optional<std::pair<fs::path, bool>> file_of_other_camera(const fs::path& file) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kSides = {
      {{"left", "right"},
       {"Left", "Right"},
       {"LEFT", "RIGHT"},
       {"cam0", "cam1"},
       {"cam_0", "cam_1"},
       {"camera0", "camera1"},
       {"camera_0", "camera_1"},
       {"cam1", "cam2"},
       {"camera1", "camera2"},
       {"infra1", "infra2"},
       {"_l.", "_r."}}};
  const std::string name = file.string();
  for (const auto& [first, second] : kSides) {
    for (const bool is_first : {true, false}) {
      const std::string_view side = is_first ? first : second;
      const std::string_view other = is_first ? second : first;
      const std::size_t at = name.rfind(side);
      if (at == std::string::npos) {
        continue;
      }
      const fs::path path = std::string(name).replace(at, side.size(), other);
      if (is_file(path)) {
        return std::pair(path, !is_first);
      }
    }
  }
  return std::nullopt;
}

/// The folder of a COLMAP model that is named, or whose cameras.txt is; else empty.
fs::path folder_of_model(const fs::path& path) {
  return is_folder(path)                    ? path
         : path.filename() == "cameras.txt" ? path.parent_path() / ""
                                            : fs::path();
}

StereoCalibration read_files(const fs::path& path, CameraChoice cameras,
                             const CalibrationChoice& choice) {
  const std::string name = path.string();
  if (const fs::path model = folder_of_model(path); !model.empty()) {
    return from_posed_images(read_colmap_model(model), name);
  }
  const std::vector<fs::path> files = calibration_files(path);
  return files.size() == 1 ? parse(text_of(read_file_bytes(files[0])), cameras, choice, name)
                           : parse_two(files, cameras, choice, name);
}

StereoCalibration read_calibration(const fs::path& path, CameraChoice cameras,
                                   const CalibrationChoice& choice) {
  try {
    StereoCalibration calibration = read_files(path, cameras, choice);
    if (choice.kitti_cameras && !calibration.kitti_cameras) {
      throw Error(fmt::format("has format {}, expected KITTI: only its cameras are selected",
                              calibration.format));
    }
    calibration.validate();
    calibration.file = path.string();
    return calibration;
  } catch (const Error& error) {
    const std::string what = error.what();
    throw what.starts_with("cannot read") ? error
                                          : Error(fmt::format("{}: {}", path.string(), what));
  }
}

}  // namespace

std::vector<fs::path> calibration_files(const fs::path& name) {
  const std::string text = name.string();
  const std::size_t comma = text.find(',');
  if (const fs::path model = folder_of_model(name); !model.empty()) {
    return {model / "cameras.txt", model / "images.txt"};
  }
  if (!is_there(name)) {
    if (comma == std::string::npos) {
      return {name};
    }
    const fs::path first = text.substr(0, comma);
    const fs::path second = text.substr(comma + 1);
    return {first, is_there(second) ? second : joined_path(first.parent_path(), second)};
  }
  const auto other = file_of_other_camera(name);
  if (!other || !are_of_one_camera(CalibrationNames(entries_of_file(name))) ||
      !are_of_one_camera(CalibrationNames(entries_of_file(other->first)))) {
    return {name};
  }
  return other->second ? std::vector{other->first, name} : std::vector{name, other->first};
}

StereoCalibration read_stereo_calibration(const fs::path& path, const CalibrationChoice& choice) {
  return read_calibration(path, CameraChoice::kPhotographs, choice);
}

StereoCalibration calibration_of_depth_matrix(const Eigen::Matrix4d& q) {
  const double per_baseline = q(3, 2);
  Eigen::Matrix4d rest = q;
  for (const auto& [row, column] :
       {std::pair{0, 0}, {0, 3}, {1, 1}, {1, 3}, {2, 3}, {3, 2}, {3, 3}}) {
    rest(row, column) = 0;
  }
  if (q(0, 0) != 1 || !(q(1, 1) > 0) || !(q(2, 3) > 0) || !(per_baseline > 0) ||
      !(rest.array() == 0).all()) {
    throw Error(
        "Q is not that of cameras side by side, expected rows (1 0 0 -cx), (0 1 0 -cy), (0 0 0 f), "
        "(0 0 1/B doffs/B)");
  }
  StereoCalibration calibration{.is_rectified = true};
  calibration.left.matrix << q(2, 3), 0, -q(0, 3), 0, q(2, 3) / q(1, 1), -q(1, 3) / q(1, 1), 0, 0,
      1;
  calibration.right.matrix = calibration.left.matrix;
  calibration.right.matrix(0, 2) += q(3, 3) / per_baseline;
  calibration.translation = {-1 / per_baseline, 0, 0};
  calibration.file = "Q";
  return calibration;
}

StereoCalibration read_rectified_calibration(const fs::path& path,
                                             const CalibrationChoice& choice) {
  return read_calibration(path, CameraChoice::kRectified, choice);
}

}  // namespace vantage
