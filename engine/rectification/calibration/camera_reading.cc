#include "engine/rectification/calibration/camera_reading.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

using Value = CalibrationValue;

std::string shape_text(int rows, int columns) {
  return rows * columns == 1 ? "a number" : fmt::format("a {}x{} matrix", rows, columns);
}

void require_numbers(const CalibrationNames::Found& found) {
  if (!found.entry->problem.empty()) {
    throw Error(fmt::format("{} {}", quotable(found.name), found.entry->problem));
  }
}

/// Letters and digits of a word, in lower case.
std::string plain(std::string_view word) {
  std::string result;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      result.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    }
  }
  return result;
}

// Words between blanks.
constexpr std::string_view kFisheyes =
    " fisheye equidistant equi kannalabrandt kannalabrandt4 kannalabrandt8 kb4 kb8 opencvfisheye "
    "true ";
constexpr std::string_view kStandards =
    " plumbbob radtan radialtangential rationalpolynomial brownconrady opencv standard none false ";
constexpr std::string_view kOthers =
    " omni omnidirectional mei ds doublesphere eucm ucm unified fov atan ftheta fisheye62 "
    "thinprismfisheye ";

bool holds(std::string_view words, std::string_view word) {
  return words.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

/// What the words of a lens model mean.
void read_lens_model(const CalibrationNames& names, CameraLabel camera, CameraReading& reading) {
  for (const CalibrationNames::Found& found : names.all(Value::kLensModel, camera)) {
    const std::vector<double>& number = found.entry->values;
    const std::string word =
        !number.empty() ? (number[0] != 0 ? "true" : "false") : plain(found.entry->word);
    if (holds(kOthers, word)) {
      throw Error(fmt::format(
          "{} is the lens model {}, which is not supported, expected OpenCV's standard model "
          "(radtan, plumb_bob, rational_polynomial) or fisheye (equidistant)",
          quotable(found.name), quotable(found.entry->word)));
    }
    const bool is_standard = holds(kStandards, word);
    if (is_standard || holds(kFisheyes, word)) {
      reading.lens = is_standard ? LensKind::kStandard : LensKind::kFisheye;
      reading.lens_name = found.name;
      return;
    }
  }
}

void read_matrix(const CalibrationNames& names, CameraLabel camera, CameraReading& reading) {
  const CalibrationNames::Found found = names.find(Value::kMatrix, camera);
  if (found.entry != nullptr && found.entry->values.size() == 4) {  // fx fy cx cy
    const std::vector<double>& v = found.entry->values;
    reading.matrix.emplace();
    *reading.matrix << v[0], 0, v[2], 0, v[1], v[3], 0, 0, 1;
  } else if (found.entry != nullptr) {
    reading.matrix = matrix_of(found);
  } else if (const auto fx = names.find(Value::kFx, camera); fx.entry != nullptr) {
    const auto of = [&](Value value, const char* name) {
      const CalibrationNames::Found number = names.find(value, camera);
      if (number.entry == nullptr) {
        throw Error(fmt::format("there is {}, but no {}, expected fx, fy, cx and cy",
                                quotable(fx.name), name));
      }
      return number_of(number);
    };
    // Before the matrix: Eigen's list of coefficients must not be left by an exception.
    const double focal_x = number_of(fx);
    const double focal_y = of(Value::kFy, "fy");
    const double centre_x = of(Value::kCx, "cx");
    const double centre_y = of(Value::kCy, "cy");
    reading.matrix.emplace();
    *reading.matrix << focal_x, 0, centre_x, 0, focal_y, centre_y, 0, 0, 1;
  }
}

void read_distortion(const CalibrationNames& names, CameraLabel camera, CameraReading& reading) {
  const CalibrationNames::Found found = names.find(Value::kDistortion, camera);
  if (found.entry != nullptr) {
    if (!found.entry->is_empty()) {
      require_numbers(found);
    }
    reading.distortion = found.entry->values;
    reading.distortion_name = found.name;
    reading.is_column = found.entry->rows == 4 && found.entry->columns == 1;
    return;
  }
  const bool is_fisheye = reading.lens == LensKind::kFisheye;
  const std::vector<std::string_view> coefficients =
      is_fisheye ? std::vector<std::string_view>{"k1", "k2", "k3", "k4"}
                 : std::vector<std::string_view>{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::size_t count = 0;
  std::vector<double> values;
  for (const std::string_view name : coefficients) {
    const CalibrationEntry* entry = names.coefficient(name, camera);
    values.push_back(entry != nullptr ? entry->values[0] : 0);
    count = entry != nullptr ? values.size() : count;
  }
  if (count > 0) {
    values.resize(count <= 4 ? 4 : count <= 5 ? 5 : 8);
    reading.distortion = std::move(values);
    reading.distortion_name = "k1";
    reading.lens = reading.lens.value_or(LensKind::kStandard);  // fisheyes have no p1
  }
}

void read_size(const CalibrationNames& names, CameraLabel camera, CameraReading& reading) {
  const CalibrationNames::Found width = names.find(Value::kImageWidth, camera);
  const CalibrationNames::Found size = names.find(Value::kImageSize, camera);
  if (width.entry != nullptr) {
    const CalibrationNames::Found height = names.find(Value::kImageHeight, camera);
    if (height.entry == nullptr) {
      throw Error(fmt::format("there is {}, but no height of the images", quotable(width.name)));
    }
    reading.size = {whole_pixels(number_of(width)), whole_pixels(number_of(height))};
  } else if (size.entry != nullptr) {
    const std::vector<double>& sides = values_of(size, 2, 1);
    reading.size = {whole_pixels(sides[0]), whole_pixels(sides[1])};
  }
}

CameraPose inverse(const CameraPose& pose) { return relative_pose(pose, CameraPose()); }

}  // namespace

const std::vector<double>& values_of(const CalibrationNames::Found& found, int rows, int columns) {
  require_numbers(found);
  const CalibrationEntry& entry = *found.entry;
  if (entry.values.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {
    throw Error(fmt::format("{} has {} values, expected {}", quotable(found.name),
                            entry.values.size(), shape_text(rows, columns)));
  }
  if (rows > 1 && columns > 1 && entry.rows != 0 && entry.rows != rows) {
    throw Error(fmt::format("{} is a {}x{} matrix, expected {}x{}", quotable(found.name),
                            entry.rows, entry.columns, rows, columns));
  }
  return entry.values;
}

Eigen::Matrix3d matrix_of(const CalibrationNames::Found& found) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      values_of(found, 3, 3).data());
}

Matrix34 projection_of(const CalibrationNames::Found& found) {
  return Eigen::Map<const Matrix34>(values_of(found, 3, 4).data());
}

CameraPose transform_of(const CalibrationNames::Found& found) {
  const std::size_t count = found.entry->values.size();
  const std::vector<double>& values = values_of(found, count == 12 ? 3 : 4, 4);
  const Eigen::Map<const Matrix34> rows(values.data());
  const std::optional<Eigen::Matrix3d> rotation = nearest_rotation(rows.leftCols<3>());
  if (!rotation) {
    throw Error(fmt::format("{} does not start with a rotation, expected rows (R | t)",
                            quotable(found.name)));
  }
  return {.rotation = *rotation, .translation = rows.col(3)};
}

double number_of(const CalibrationNames::Found& found) { return values_of(found, 1, 1)[0]; }

int whole_pixels(double value) {
  if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
    throw Error(fmt::format("the image size holds {}, expected whole pixels", value));
  }
  return static_cast<int>(value);
}

Camera CameraReading::camera() const {
  return {.matrix = matrix.value_or(Eigen::Matrix3d::Zero()),
          .distortion = distortion,
          .lens = lens.value_or(LensKind::kStandard)};
}

CameraReading read_camera(const CalibrationNames& names, CameraLabel camera) {
  CameraReading reading;
  read_lens_model(names, camera, reading);
  read_matrix(names, camera, reading);
  read_distortion(names, camera, reading);
  read_size(names, camera, reading);
  if (const auto found = names.find(Value::kRectification, camera); found.entry != nullptr) {
    if (found.entry->values.size() == 9) {
      reading.rectification = matrix_of(found);
    }
  }
  if (const auto found = names.find(Value::kProjection, camera); found.entry != nullptr) {
    reading.projection = projection_of(found);
  }
  if (const auto found = names.find(Value::kFromPrevious, camera); found.entry != nullptr) {
    reading.from_previous = transform_of(found);
  }
  if (const auto found = names.find(Value::kFromBody, camera); found.entry != nullptr) {
    reading.from_body = transform_of(found);
  } else if (const auto pose = names.find(Value::kPoseInBody, camera); pose.entry != nullptr) {
    reading.from_body = inverse(transform_of(pose));
  }
  return reading;
}

void choose_lenses(std::span<CameraReading> cameras, std::optional<LensKind> wanted,
                   const std::string& file, std::vector<Remark>& remarks) {
  const bool has_others = std::ranges::any_of(cameras, [](const CameraReading& camera) {
    return !camera.distortion.empty() && camera.distortion.size() != 4;
  });
  for (CameraReading& camera : cameras) {
    if (camera.lens && wanted && camera.lens != wanted && !camera.distortion.empty()) {
      throw Error(fmt::format("{} says what the lens is, and `lens` says otherwise",
                              quotable(camera.lens_name)));
    }
    const bool is_open = camera.distortion.size() == 4 && !has_others &&
                         std::ranges::any_of(camera.distortion, [](double k) { return k != 0; });
    if (!camera.lens && !wanted && is_open) {
      if (camera.is_column) {
        throw Error(fmt::format(
            "{} is 4x1 and no key says of which lens, expected `lens` fisheye (k1 k2 k3 k4, as "
            "cv2.fisheye writes it) or standard (k1 k2 p1 p2)",
            quotable(camera.distortion_name)));
      }
      remarks.push_back(
          {.kind = Remark::Kind::kNote,
           .subject = "lens",
           .text = fmt::format("{}: the four coefficients of {} count as k1 k2 p1 p2; "
                               "`lens` fisheye for those of cv2.fisheye",
                               file, quotable(camera.distortion_name))});
    }
    if (!camera.lens && (is_open || !camera.distortion.empty())) {
      camera.lens = wanted.value_or(LensKind::kStandard);
    }
    if (camera.lens == LensKind::kFisheye) {
      camera.distortion.resize(std::max<std::size_t>(camera.distortion.size(), 4));
    }
  }
}

void look_at_unknown_distortion(const CalibrationNames& names,
                                std::span<const CameraReading> cameras, const std::string& file,
                                std::vector<Remark>& remarks) {
  for (const std::string& unknown : names.unknown_distortions()) {
    if (std::ranges::any_of(cameras, &std::string::empty, &CameraReading::distortion_name)) {
      throw Error(fmt::format(
          "{} looks like distortion, but is not a name that is known, expected one of {}, likewise "
          "with 2, left and right, L and R, or cam0 and cam1, before or after",
          unknown, CalibrationNames::taken(Value::kDistortion, "1")));
    }
    remarks.push_back({.kind = Remark::Kind::kWarning,
                       .subject = "calibration",
                       .text = fmt::format("{}: {} looks like distortion, and is not used: {} is",
                                           file, unknown, cameras[0].distortion_name)});
  }
}

}  // namespace vantage
