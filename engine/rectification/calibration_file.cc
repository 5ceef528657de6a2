#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <initializer_list>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/rectification/calibration_entries.h"
#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {
namespace {

constexpr std::size_t kMaxBytes = 16U << 20;

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

std::string shape_text(int rows, int columns) {
  return rows * columns == 1 ? "a number" : fmt::format("a {}x{} matrix", rows, columns);
}

/// The entries of a file, asked for by name.
class CalibrationFile {
 public:
  explicit CalibrationFile(CalibrationEntries entries) : entries_(std::move(entries)) {}

  /// The first of these entries that exists, null if none does. Throws Error when it does not hold
  /// numbers.
  [[nodiscard]] const CalibrationEntry* find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names) {
      const auto entry = entries_.find(name);
      if (entry != entries_.end()) {
        if (!entry->second.problem.empty()) {
          throw Error(fmt::format("{} {}", name, entry->second.problem));
        }
        return &entry->second;
      }
    }
    return nullptr;
  }

  /// Like find(), but the entry is required, with rows · columns values.
  [[nodiscard]] const std::vector<double>& values(std::initializer_list<std::string_view> names,
                                                  int rows, int columns) const {
    const CalibrationEntry* entry = find(names);
    const std::string_view name = *names.begin();
    if (entry == nullptr) {
      throw Error(
          fmt::format("there is no {} in it, expected {}", name, shape_text(rows, columns)));
    }
    if (entry->values.size() !=
        static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {
      throw Error(fmt::format("{} has {} values, expected {}", name, entry->values.size(),
                              shape_text(rows, columns)));
    }
    if (rows > 1 && columns > 1 && entry->rows != 0 && entry->rows != rows) {
      throw Error(fmt::format("{} is a {}x{} matrix, expected {}x{}", name, entry->rows,
                              entry->columns, rows, columns));
    }
    return entry->values;
  }

  [[nodiscard]] Eigen::Matrix3d matrix(std::initializer_list<std::string_view> names) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        values(names, 3, 3).data());
  }
  [[nodiscard]] double number(std::string_view name) const { return values({name}, 1, 1)[0]; }

  /// Throws Error when the file names a fisheye model.
  void refuse_fisheyes() const {
    for (const auto& [name, entry] : entries_) {
      const bool is_switch = name == "fisheye_model" && entry.values != std::vector<double>{0};
      const bool is_model = name.find("model") != std::string::npos &&
                            (entry.word == "fisheye" || entry.word == "equidistant" ||
                             entry.word == "kannala_brandt" || entry.word == "KANNALA_BRANDT");
      if (is_switch || is_model) {
        throw Error(fmt::format(
            "{} means fisheye lenses, which are not supported, expected OpenCV's standard "
            "model (k1 k2 p1 p2 ...)",
            name));
      }
    }
  }

 private:
  CalibrationEntries entries_;
};

int whole_pixels(double value) {
  if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
    throw Error(fmt::format("the image size holds {}, expected whole pixels", value));
  }
  return static_cast<int>(value);
}

/// Which cameras are wanted of a file that has those of photographs and of rectified images.
enum class CameraChoice { kPhotographs, kRectified };

bool has_grey_cameras(const CalibrationFile& file) {
  return file.find({"P0", "P_rect_00"}) != nullptr;
}

bool has_colour_cameras(const CalibrationFile& file) {
  return file.find({"P2", "P_rect_02"}) != nullptr && file.find({"P3", "P_rect_03"}) != nullptr;
}

/// Two cameras of a rig, each given as P = K · (I | t).
StereoCalibration from_projections(const Matrix34& left, const Matrix34& right) {
  StereoCalibration calibration{.is_rectified = true};
  calibration.left.matrix = left.leftCols<3>();
  calibration.right.matrix = right.leftCols<3>();
  calibration.left.validate("left camera");
  calibration.right.validate("right camera");
  calibration.translation = calibration.right.matrix.inverse() * right.col(3) -
                            calibration.left.matrix.inverse() * left.col(3);
  return calibration;
}

/// The cameras of images that OpenCV has rectified; empty if the file does not have them.
std::optional<StereoCalibration> from_rectified_opencv(const CalibrationFile& file) {
  std::optional<StereoCalibration> calibration;
  const auto projection = [&](std::string_view name) -> Matrix34 {
    return Eigen::Map<const Matrix34>(file.values({name}, 3, 4).data());
  };
  if (file.find({"P1"}) != nullptr && file.find({"P2"}) != nullptr) {
    calibration = from_projections(projection("P1"), projection("P2"));
    calibration->format = "OpenCV, P1 and P2";
  } else if (file.find({"Q"}) != nullptr) {
    calibration =
        calibration_of_depth_matrix(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(
            file.values({"Q"}, 4, 4).data()));
    calibration->format = "OpenCV, Q";
  }
  return calibration;
}

void read_opencv_size_and_unit(const CalibrationFile& file, StereoCalibration& calibration) {
  if (file.find({"image_width"}) != nullptr) {
    calibration.image_size = {whole_pixels(file.number("image_width")),
                              whole_pixels(file.number("image_height"))};
  } else if (file.find({"imageSize", "image_size"}) != nullptr) {
    const std::vector<double>& size = file.values({"imageSize", "image_size"}, 2, 1);
    calibration.image_size = {whole_pixels(size[0]), whole_pixels(size[1])};
  }
  if (file.find({"metres_per_unit"}) != nullptr) {
    const double length = file.number("metres_per_unit");
    if (!(length >= 0 && std::isfinite(length))) {
      throw Error(fmt::format("metres_per_unit is {}, expected a number above 0, or 0 for no scale",
                              length));
    }
    calibration.has_scale = length > 0;
    if (length > 0) {
      calibration.metres_per_unit = length;
    }
  }
}

StereoCalibration from_opencv(const CalibrationFile& file, CameraChoice choice) {
  static const std::initializer_list<std::string_view> kLeftNames = {"M1", "K1", "cameraMatrix1",
                                                                     "camera_matrix_1"};
  if (choice == CameraChoice::kRectified || file.find(kLeftNames) == nullptr) {
    if (std::optional<StereoCalibration> rectified = from_rectified_opencv(file)) {
      read_opencv_size_and_unit(file, *rectified);
      return *rectified;
    }
  }
  file.refuse_fisheyes();
  StereoCalibration calibration{.format = "OpenCV"};
  calibration.left.matrix = file.matrix(kLeftNames);
  calibration.right.matrix = file.matrix({"M2", "K2", "cameraMatrix2", "camera_matrix_2"});
  if (const CalibrationEntry* d = file.find({"D1", "distCoeffs1", "dist_coeffs_1"})) {
    calibration.left.distortion = d->values;
  }
  if (const CalibrationEntry* d = file.find({"D2", "distCoeffs2", "dist_coeffs_2"})) {
    calibration.right.distortion = d->values;
  }
  if (file.find({"R"}) == nullptr || file.find({"T", "t"}) == nullptr) {
    throw Error(
        "it has no R and T, expected intrinsics (M1, D1, M2, D2) and extrinsics (R, T) in one "
        "file");
  }
  const Eigen::Matrix3d rotation = file.matrix({"R"});
  calibration.rotation = nearest_rotation(rotation).value_or(rotation);
  calibration.translation = Eigen::Map<const Eigen::Vector3d>(file.values({"T", "t"}, 3, 1).data());
  read_opencv_size_and_unit(file, calibration);
  Eigen::Matrix3d difference = calibration.left.matrix - calibration.right.matrix;
  difference(0, 2) = 0;
  calibration.is_rectified = difference.isZero(0) && calibration.left.is_without_distortion() &&
                             calibration.right.is_without_distortion() &&
                             calibration.rotation == Eigen::Matrix3d::Identity() &&
                             calibration.translation.x() < 0 && calibration.translation.y() == 0 &&
                             calibration.translation.z() == 0;
  return calibration;
}

StereoCalibration from_middlebury(const CalibrationFile& file) {
  StereoCalibration calibration{
      .metres_per_unit = 0.001, .is_rectified = true, .format = "Middlebury"};
  calibration.left.matrix = file.matrix({"cam0"});
  calibration.right.matrix = file.matrix({"cam1"});
  calibration.translation = {-file.number("baseline"), 0, 0};
  calibration.image_size = {whole_pixels(file.number("width")),
                            whole_pixels(file.number("height"))};
  if (file.find({"doffs"}) != nullptr &&
      !(std::abs(file.number("doffs") - calibration.doffs_px()) <= 0.1)) {
    throw Error(fmt::format("doffs is {}, but cx of cam1 is {:.6g} more than of cam0",
                            file.number("doffs"), calibration.doffs_px()));
  }
  return calibration;
}

StereoCalibration from_kitti(const CalibrationFile& file, std::optional<KittiCameras> cameras) {
  const auto projection = [&](std::string_view name, std::string_view other_name) -> Matrix34 {
    return Eigen::Map<const Matrix34>(file.values({name, other_name}, 3, 4).data());
  };
  const bool is_grey = cameras ? cameras == KittiCameras::kGrey : has_grey_cameras(file);
  const Matrix34 left = is_grey ? projection("P0", "P_rect_00") : projection("P2", "P_rect_02");
  const Matrix34 right = is_grey ? projection("P1", "P_rect_01") : projection("P3", "P_rect_03");
  StereoCalibration calibration = from_projections(left, right);
  calibration.metres_per_unit = 1;
  calibration.kitti_cameras = is_grey ? KittiCameras::kGrey : KittiCameras::kColour;
  calibration.has_other_cameras = has_grey_cameras(file) && has_colour_cameras(file);
  calibration.format = is_grey ? "KITTI, cameras 0 and 1" : "KITTI, cameras 2 and 3";
  const char* size_name = is_grey ? "S_rect_00" : "S_rect_02";
  if (file.find({size_name}) != nullptr) {
    const std::vector<double>& size = file.values({size_name}, 2, 1);
    calibration.image_size = {whole_pixels(size[0]), whole_pixels(size[1])};
  }
  return calibration;
}

/// KITTI's odometry sequences are distributed with and without names: lines of 12 numbers. Empty
/// for any other text.
CalibrationEntries nameless_projections(std::string_view text) {
  const CalibrationEntry all = numbers_of(text);
  CalibrationEntries entries;
  if (all.values.size() == 24 || all.values.size() == 48) {
    for (std::size_t i = 0; i < all.values.size() / 12; ++i) {
      const auto first = all.values.begin() + static_cast<std::ptrdiff_t>(12 * i);
      entries[fmt::format("P{}", i)] = {.values = {first, first + 12}};
    }
  }
  return entries;
}

StereoCalibration parse(std::string_view text, CameraChoice choice,
                        std::optional<KittiCameras> cameras) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && text[first] == '<') {
    return from_opencv(CalibrationFile(xml_entries(text)), choice);
  }
  if (CalibrationEntries entries = assignment_entries(text); entries.contains("cam0")) {
    return from_middlebury(CalibrationFile(std::move(entries)));
  }
  if (CalibrationEntries entries = nameless_projections(text); !entries.empty()) {
    return from_kitti(CalibrationFile(std::move(entries)), cameras);
  }
  CalibrationEntries entries = yaml_entries(text);
  // OpenCV numbers its cameras from 1, KITTI from 0.
  const bool has_opencv_projections = entries.contains("P1") && entries.contains("P2") &&
                                      !entries.contains("P0") && !entries.contains("P3");
  if (has_opencv_projections || entries.contains("Q")) {
    return from_opencv(CalibrationFile(std::move(entries)), choice);
  }
  for (const char* name : {"P0", "P1", "P2", "P3", "P_rect_00", "P_rect_02"}) {
    if (entries.contains(name) && !entries.contains("R") && !entries.contains("T")) {
      return from_kitti(CalibrationFile(std::move(entries)), cameras);
    }
  }
  for (const char* name : {"M1", "K1", "cameraMatrix1", "camera_matrix_1", "R", "T"}) {
    if (entries.contains(name)) {
      return from_opencv(CalibrationFile(std::move(entries)), choice);
    }
  }
  throw Error(
      "it is not a stereo calibration, expected OpenCV's YAML or XML, or calib.txt of Middlebury "
      "or KITTI");
}

StereoCalibration read_calibration(const std::filesystem::path& path, CameraChoice choice,
                                   std::optional<KittiCameras> cameras) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  try {
    if (bytes.size() > kMaxBytes) {
      throw Error(
          fmt::format("it has {} bytes, expected a text of at most {}", bytes.size(), kMaxBytes));
    }
    StereoCalibration calibration =
        parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, choice, cameras);
    if (cameras && !calibration.kitti_cameras) {
      throw Error(fmt::format("has format {}, expected KITTI: only its cameras are selected",
                              calibration.format));
    }
    calibration.validate();
    calibration.file = path.string();
    return calibration;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

StereoCalibration read_stereo_calibration(const std::filesystem::path& path,
                                          std::optional<KittiCameras> cameras) {
  return read_calibration(path, CameraChoice::kPhotographs, cameras);
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

StereoCalibration read_rectified_calibration(const std::filesystem::path& path,
                                             std::optional<KittiCameras> cameras) {
  return read_calibration(path, CameraChoice::kRectified, cameras);
}

}  // namespace vantage
