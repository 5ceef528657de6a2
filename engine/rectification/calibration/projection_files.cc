#include "engine/rectification/calibration/projection_files.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

using Found = CalibrationNames::Found;

/// The first of these entries that exists, under its name; null if none does.
Found first_of(const CalibrationEntries& entries, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    if (const auto entry = entries.find(name); entry != entries.end()) {
      return {entry->first, &entry->second};
    }
  }
  return {};
}

/// The same; throws Error if none does.
Found required(const CalibrationEntries& entries, std::initializer_list<std::string_view> names,
               const char* shape) {
  Found found = first_of(entries, names);
  if (found.entry == nullptr) {
    throw Error(fmt::format("there is no {} in it, expected {}", *names.begin(), shape));
  }
  return found;
}

/// The numbers behind P_rect_ of files like KITTI's with cameras of other numbers (DrivingStereo).
std::vector<std::string> other_kitti_numbers(const CalibrationEntries& entries) {
  constexpr std::string_view kStart = "P_rect_";
  std::vector<std::string> numbers;
  for (const auto& [name, entry] : entries) {
    if (name.starts_with(kStart) && name.size() > kStart.size() + 2) {
      numbers.push_back(name.substr(kStart.size()));
    }
  }
  return numbers;
}

void read_kitti_size(const CalibrationEntries& entries, const std::string& number,
                     StereoCalibration& calibration) {
  const Found size = first_of(entries, {"S_rect_" + number});
  if (size.entry != nullptr) {
    const std::vector<double>& sides = values_of(size, 2, 1);
    calibration.image_size = {whole_pixels(sides[0]), whole_pixels(sides[1])};
  }
}

}  // namespace

StereoCalibration from_projections(const Matrix34& left, const Matrix34& right) {
  StereoCalibration calibration{.is_rectified = true};
  calibration.left.matrix = left.leftCols<3>();
  calibration.right.matrix = right.leftCols<3>();
  calibration.left.validate("left camera");
  calibration.right.validate("right camera");
  calibration.translation = calibration.right.matrix.inverse() * right.col(3) -
                            calibration.left.matrix.inverse() * left.col(3);
  if (!(calibration.baseline() >= 1e-9)) {
    throw Error(fmt::format(
        "the projections P of both cameras have the same Tx, {:g} (row 1, column 4), expected "
        "-fx * baseline in that of the right one: as they are, the cameras are at one place",
        right(0, 3)));
  }
  return calibration;
}

StereoCalibration from_middlebury(const CalibrationEntries& entries) {
  const auto number = [&](const char* name) {
    return number_of(required(entries, {name}, "a number"));
  };
  StereoCalibration calibration{
      .metres_per_unit = 0.001, .is_rectified = true, .format = "Middlebury"};
  calibration.left.matrix = matrix_of(required(entries, {"cam0"}, "a 3x3 matrix"));
  calibration.right.matrix = matrix_of(required(entries, {"cam1"}, "a 3x3 matrix"));
  calibration.translation = {-number("baseline"), 0, 0};
  calibration.image_size = {whole_pixels(number("width")), whole_pixels(number("height"))};
  if (entries.contains("doffs") && !(std::abs(number("doffs") - calibration.doffs_px()) <= 0.1)) {
    throw Error(fmt::format("doffs is {}, but cx of cam1 is {:.6g} more than of cam0",
                            number("doffs"), calibration.doffs_px()));
  }
  return calibration;
}

StereoCalibration from_kitti(const CalibrationEntries& entries,
                             std::optional<KittiCameras> cameras) {
  const auto projection = [&](const std::string& name, const std::string& other) {
    return projection_of(required(entries, {name, other}, "a 3x4 matrix"));
  };
  const std::vector<std::string> others = other_kitti_numbers(entries);
  if (others.size() >= 2) {
    const auto of = [&](std::size_t i) { return projection("P_rect_" + others[i], ""); };
    StereoCalibration calibration = from_projections(of(0), of(1));
    calibration.metres_per_unit = 1;
    calibration.format = fmt::format("KITTI, cameras {} and {}", others[0], others[1]);
    read_kitti_size(entries, others[0], calibration);
    return calibration;
  }
  const bool has_grey = first_of(entries, {"P0", "P_rect_00"}).entry != nullptr;
  const bool has_colour = first_of(entries, {"P2", "P_rect_02"}).entry != nullptr &&
                          first_of(entries, {"P3", "P_rect_03"}).entry != nullptr;
  const bool is_grey = cameras ? cameras == KittiCameras::kGrey : has_grey;
  const Matrix34 left = is_grey ? projection("P0", "P_rect_00") : projection("P2", "P_rect_02");
  const Matrix34 right = is_grey ? projection("P1", "P_rect_01") : projection("P3", "P_rect_03");
  StereoCalibration calibration = from_projections(left, right);
  calibration.metres_per_unit = 1;
  calibration.kitti_cameras = is_grey ? KittiCameras::kGrey : KittiCameras::kColour;
  calibration.has_other_cameras = has_grey && has_colour;
  calibration.format = is_grey ? "KITTI, cameras 0 and 1" : "KITTI, cameras 2 and 3";
  read_kitti_size(entries, is_grey ? "00" : "02", calibration);
  return calibration;
}

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

bool are_of_kitti(const CalibrationEntries& entries) {
  if (entries.contains("R") || entries.contains("T") || entries.contains("Q")) {
    return false;
  }
  if (entries.contains("P1") && entries.contains("P2") && !entries.contains("P0") &&
      !entries.contains("P3")) {
    return false;
  }
  return first_of(entries, {"P0", "P1", "P2", "P3", "P_rect_00", "P_rect_02"}).entry != nullptr ||
         other_kitti_numbers(entries).size() >= 2;
}

}  // namespace vantage
