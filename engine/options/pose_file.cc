#include "engine/options/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/json_text.h"
#include "engine/options/matrix_rows.h"
#include "engine/options/nearest_name.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

const std::vector<std::string> kKeys = {"at", "K", "R", "t", "size", "frame"};

SettingValue read_json(const std::string& path) {
  const std::string text = read_file_text(path);
  try {
    return parse_json(text, path);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

// The numbers of a value, which may be nested one deep as rows.
std::vector<double> numbers_of(const SettingValue& value, std::size_t count,
                               const std::string& what) {
  std::vector<double> numbers;
  bool all_are_numbers = value.is_array();
  for (const SettingValue& member : value) {
    for (const SettingValue& number : to_list(member)) {
      all_are_numbers = all_are_numbers && number.is_number();
      numbers.push_back(number.is_number() ? number.get<double>() : 0);
    }
  }
  if (!all_are_numbers || numbers.size() != count) {
    throw UsageError(
        fmt::format("{} is {}, expected a list of {} numbers", what, quoted_json(value), count));
  }
  return numbers;
}

int whole_number_of(double number, const std::string& what) {
  constexpr double kLargest = 1e9;
  if (!(number >= 0 && number <= kLargest) || number != static_cast<int>(number)) {
    throw UsageError(fmt::format("{} is {}, expected a whole number from 0", what, number));
  }
  return static_cast<int>(number);
}

Eigen::Matrix3d matrix_of(const SettingValue& value, const std::string& what) {
  const std::vector<double> numbers = numbers_of(value, 9, what);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

PosedCamera camera_of(const SettingValue& entry, const std::string& where) {
  for (const char* key : {"K", "R", "t"}) {
    if (!entry.contains(key)) {
      throw UsageError(
          fmt::format("{} has no {}, expected at = [XS, YS] or all of K, R and t", where, key));
    }
  }
  PosedCamera camera;
  camera.matrix = matrix_of(entry["K"], where + ": K");
  camera.rotation = matrix_of(entry["R"], where + ": R");
  const std::vector<double> translation = numbers_of(entry["t"], 3, where + ": t");
  camera.translation = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  if (entry.contains("size")) {
    const std::vector<double> size = numbers_of(entry["size"], 2, where + ": size");
    camera.width_px = whole_number_of(size[0], where + ": size");
    camera.height_px = whole_number_of(size[1], where + ": size");
    if (camera.width_px < 1 || camera.height_px < 1) {
      throw UsageError(fmt::format("{}: size is {}x{}, expected at least 1 pixel each way", where,
                                   camera.width_px, camera.height_px));
    }
  }
  return camera;
}

PoseEntry entry_of(const SettingValue& entry, const std::string& where) {
  if (!entry.is_object()) {
    throw UsageError(fmt::format("{} is {}, expected a table", where, quoted_json(entry)));
  }
  for (const auto& [key, value] : entry.items()) {
    if (std::ranges::find(kKeys, key) == kKeys.end()) {
      throw UsageError(
          fmt::format("{}: unknown key '{}'{}", where, quotable(key), hint_for_key(key, kKeys)));
    }
  }
  PoseEntry result;
  if (entry.contains("frame")) {
    if (!entry["frame"].is_number()) {
      throw UsageError(fmt::format("{}: frame is {}, expected a whole number from 0", where,
                                   quoted_json(entry["frame"])));
    }
    result.frame = whole_number_of(entry["frame"].get<double>(), where + ": frame");
  }
  if (!entry.contains("at")) {
    result.pose = camera_of(entry, where);
    return result;
  }
  for (const char* key : {"K", "R", "t", "size"}) {
    if (entry.contains(key)) {
      throw UsageError(
          fmt::format("{} has both 'at' and '{}', expected a position or a camera", where, key));
    }
  }
  const std::vector<double> at = numbers_of(entry["at"], 2, where + ": at");
  result.pose = BaselinePosition{at[0], at[1]};
  return result;
}

SettingValue value_of(const PoseEntry& pose) {
  SettingValue entry = SettingValue::object();
  if (pose.frame) {
    entry["frame"] = *pose.frame;
  }
  if (const auto* camera = std::get_if<PosedCamera>(&pose.pose)) {
    const Eigen::Vector3d& t = camera->translation;
    entry["K"] = rows_of(camera->matrix);
    entry["R"] = rows_of(camera->rotation);
    entry["t"] = {t.x(), t.y(), t.z()};
    if (camera->width_px > 0) {
      entry["size"] = {camera->width_px, camera->height_px};
    }
  } else {
    const auto& position = std::get<BaselinePosition>(pose.pose);
    entry["at"] = {position.x, position.y};
  }
  return entry;
}

}  // namespace

std::vector<PoseEntry> read_poses(const std::string& path, const DocumentReader& read_toml) {
  const SettingValue document =
      lower_case_extension(path) == ".json" ? read_json(path) : read_toml(path);
  if (!document.is_object() || !document.contains("view") || !document["view"].is_array() ||
      document["view"].empty() || document.size() != 1) {
    throw UsageError(fmt::format(
        "{}: expected a list 'view' of poses, [[view]] in TOML, and nothing else", path));
  }
  return poses_in(document["view"], path);
}

std::vector<PoseEntry> poses_in(const SettingValue& list, const std::string& name) {
  std::vector<PoseEntry> poses;
  for (const SettingValue& entry : list) {
    poses.push_back(entry_of(entry, fmt::format("{}: view {}", name, poses.size() + 1)));
  }
  return poses;
}

SettingValue to_value(const std::vector<PoseEntry>& poses) {
  SettingValue list = SettingValue::array();
  for (const PoseEntry& pose : poses) {
    list.push_back(value_of(pose));
  }
  return list;
}

std::vector<PoseEntry> entries_of(const PoseList& list, const DocumentReader& read_toml) {
  return list.file.empty() ? list.entries : read_poses(list.file, read_toml);
}

}  // namespace vantage
