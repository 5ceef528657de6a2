#include "engine/rectification/calibration/calibration_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "engine/quoted_text.h"

namespace vantage {
namespace {

using Value = CalibrationValue;

/// How many numbers an entry has; the names of numbers and of matrices overlap (k1, p1).
enum class Shape { kNumber, kSeveral, kAny };

struct NamesOfValue {
  Value value;
  Shape shape;
  std::vector<std::string_view> names;  ///< the first that is there counts
};

/// The one table of names. Labels of cameras stand before or after them: K1, leftK,
/// cam0.intrinsics.
const std::vector<NamesOfValue>& names_of_values() {
  static const std::vector<NamesOfValue> kNames = {
      {Value::kMatrix,
       Shape::kSeveral,
       {"M", "K", "cameraMatrix", "mtx", "intrinsics", "intrinsicMatrix", "intrinsic", "camMatrix",
        "cameraMat", "camMat", "cameraMtx", "intrinsicsMatrix", "matrix", "KMat", "CM"}},
      {Value::kDistortion,
       Shape::kSeveral,
       {"D",
        "distCoeffs",
        "dist",
        "distCoeff",
        "distortionCoefficients",
        "distortionCoeffs",
        "distortion",
        "distCoef",
        "distCoefs",
        "distortionCoeff",
        "distortionCoefs",
        "distortionCoefficient",
        "distCoefficients",
        "distortionParameters",
        "distortionParams",
        "distParams",
        "distortions",
        "lensDistortion",
        "dCoeffs",
        "kc"}},
      {Value::kLensModel,
       Shape::kAny,
       {"fisheyeModel", "fisheye", "isFisheye", "StereoRectifier.model", "distortionModel",
        "distortionType", "lensModel", "cameraModel", "Camera.type", "model"}},
      {Value::kRectification,
       Shape::kSeveral,
       {"R", "rectificationMatrix", "rectification", "RRect", "rectR"}},
      {Value::kProjection,
       Shape::kSeveral,
       {"P", "projectionMatrix", "projection", "PRect", "rectP"}},
      {Value::kImageSize,
       Shape::kSeveral,
       {"imageSize", "imgSize", "resolution", "size", "imageShape"}},
      {Value::kImageWidth, Shape::kNumber, {"imageWidth", "width", "imgWidth", "w"}},
      {Value::kImageHeight, Shape::kNumber, {"imageHeight", "height", "imgHeight", "h"}},
      {Value::kFx, Shape::kNumber, {"fx", "fu", "fl_x", "focalLengthX"}},
      {Value::kFy, Shape::kNumber, {"fy", "fv", "fl_y", "focalLengthY"}},
      {Value::kCx, Shape::kNumber, {"cx", "cu", "ppx", "principalPointX"}},
      {Value::kCy, Shape::kNumber, {"cy", "cv", "ppy", "principalPointY"}},
      {Value::kFromPrevious, Shape::kSeveral, {"T_cn_cnm1"}},
      {Value::kPoseInBody, Shape::kSeveral, {"T_BS", "T_body_cam", "T_imu_cam"}},
      {Value::kFromBody, Shape::kSeveral, {"T_cam_imu", "T_cam_body"}},
      {Value::kRotation,
       Shape::kSeveral,
       {"R", "rotation", "rotationMatrix", "rot", "RStereo", "stereoR", "RMat", "rvec",
        "rotationVector", "om", "rodrigues"}},
      {Value::kTranslation,
       Shape::kSeveral,
       {"T", "translation", "translationVector", "trans", "trns", "TStereo", "stereoT", "tvec"}},
      {Value::kFromRight, Shape::kSeveral, {"Stereo.T_c1_c2", "T_c1_c2", "Tlr"}},
      {Value::kDepthMatrix, Shape::kSeveral, {"Q", "disparityToDepth", "dispToDepth"}},
      {Value::kBaseline, Shape::kNumber, {"Stereo.b", "baseline"}},
      {Value::kFocalBaseline, Shape::kNumber, {"Camera.bf", "bf", "focal_x_baseline"}},
      {Value::kMetresPerUnit, Shape::kNumber, {"metres_per_unit", "meters_per_unit"}},
  };
  return kNames;
}

const NamesOfValue& names_of(Value value) {
  return *std::ranges::find(names_of_values(), value, &NamesOfValue::value);
}

bool is_separator(char c) { return c == '_' || c == '-' || c == '.' || c == ' '; }

/// Letters and digits, in lower case.
std::string spelling_of(std::string_view name) {
  std::string spelling;
  for (const char c : name) {
    if (!is_separator(c)) {
      spelling.push_back(c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
    }
  }
  return spelling;
}

/// Whether what is not of one camera is of both.
bool may_be_shared(Value value) {
  return value <= Value::kLensModel || (value >= Value::kImageSize && value <= Value::kCy);
}

}  // namespace

const CalibrationNames::Labels CalibrationNames::kSides = {
    {{"left", "l", "leftcamera", "leftcam", "cameraleft", "camleft"},
     {"right", "r", "rightcamera", "rightcam", "cameraright", "camright"}}};
const CalibrationNames::Labels CalibrationNames::kFromOne = {
    {{"1", "01", "cam1", "camera1"}, {"2", "02", "cam2", "camera2"}}};
const CalibrationNames::Labels CalibrationNames::kFromZero = {
    {{"0", "00", "cam0", "camera0"}, {"1", "01", "cam1", "camera1"}}};

CalibrationNames::CalibrationNames(CalibrationEntries entries) : entries_(std::move(entries)) {
  for (const auto& [name, entry] : entries_) {
    by_spelling_.try_emplace(spelling_of(name), name);
  }
  for (const auto& [name, entry] : entries_) {
    // Without nodes around it, or with the outermost of them alone.
    for (std::string_view rest = name;;) {
      const std::size_t dot = rest.find('.');
      if (dot == std::string_view::npos) {
        break;
      }
      const std::string first = spelling_of(rest.substr(0, dot));
      by_spelling_.try_emplace(first + spelling_of(rest.substr(rest.rfind('.') + 1)), name);
      if (is_label(first)) {
        break;
      }
      rest.remove_prefix(dot + 1);
      by_spelling_.try_emplace(spelling_of(rest), name);
    }
  }
  int most = 0;
  const Labels* best = &kSides;
  for (const Labels* labels : {&kSides, &kFromOne, &kFromZero}) {
    labels_ = labels;
    int count = 0;
    for (const CameraLabel camera : {CameraLabel::kFirst, CameraLabel::kSecond}) {
      for (const Value value : {Value::kMatrix, Value::kFx, Value::kProjection}) {
        count += find(value, camera, Sharing::kOwn).entry != nullptr ? 1 : 0;
      }
    }
    if (count > most) {
      most = count;
      best = labels;
    }
  }
  labels_ = best;
}

bool CalibrationNames::is_label(std::string_view name) {
  for (const Labels* labels : {&kSides, &kFromOne, &kFromZero}) {
    for (const auto& names : *labels) {
      if (std::ranges::find(names, name) != names.end()) {
        return true;
      }
    }
  }
  return false;
}

template <typename Fits>
CalibrationNames::Found CalibrationNames::find_named(std::string_view name, CameraLabel camera,
                                                     const Fits& fits) const {
  std::vector<std::string_view> labels = {""};
  if (camera != CameraLabel::kNone) {
    const std::size_t i = camera == CameraLabel::kFirst ? 0 : 1;
    labels = (*labels_)[i];
    labels.insert(labels.end(), kSides[i].begin(), kSides[i].end());  // K1, but D_left
  }
  const std::string spelling = spelling_of(name);
  for (const std::string_view label : labels) {
    for (const std::string& whole :
         {spelling + std::string(label), std::string(label) + spelling}) {
      const auto found = by_spelling_.find(whole);
      if (found != by_spelling_.end() && fits(entries_.at(found->second))) {
        return {found->second, &entries_.at(found->second)};
      }
    }
  }
  return {};
}

std::vector<CalibrationNames::Found> CalibrationNames::all(Value value, CameraLabel camera,
                                                           Sharing sharing) const {
  const NamesOfValue& names = names_of(value);
  std::vector<Found> all;
  for (const CameraLabel label : {camera, CameraLabel::kNone}) {
    for (const std::string_view name : names.names) {
      Found found = find_named(name, label, [&](const CalibrationEntry& entry) {
        return names.shape == Shape::kAny ||
               (names.shape == Shape::kNumber) == (entry.values.size() == 1) ||
               !entry.problem.empty();
      });
      if (found.entry != nullptr) {
        all.push_back(std::move(found));
      }
    }
    if (camera == CameraLabel::kNone || sharing == Sharing::kOwn || !may_be_shared(value)) {
      break;
    }
  }
  return all;
}

CalibrationNames::Found CalibrationNames::find(Value value, CameraLabel camera,
                                               Sharing sharing) const {
  std::vector<Found> found = all(value, camera, sharing);
  return found.empty() ? Found() : std::move(found.front());
}

const CalibrationEntry* CalibrationNames::coefficient(std::string_view name,
                                                      CameraLabel camera) const {
  const auto is_number = [](const CalibrationEntry& entry) { return entry.values.size() == 1; };
  const CalibrationEntry* own = find_named(name, camera, is_number).entry;
  return own != nullptr ? own : find_named(name, CameraLabel::kNone, is_number).entry;
}

std::vector<std::string> CalibrationNames::unknown_distortions() const {
  std::set<std::string> known;
  for (const CameraLabel camera : {CameraLabel::kNone, CameraLabel::kFirst, CameraLabel::kSecond}) {
    known.insert(find(Value::kDistortion, camera, Sharing::kOwn).name);
  }
  const auto holds = [](std::string_view text, std::initializer_list<std::string_view> parts) {
    return std::ranges::any_of(
        parts, [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
  };
  std::vector<std::string> unknown;
  for (const auto& [name, entry] : entries_) {
    const std::string spelling = spelling_of(name);
    if (holds(spelling, {"dist", "coef", "radial", "tangential"}) &&
        !holds(spelling, {"undist", "distance", "model"}) && !known.contains(name) &&
        std::ranges::any_of(entry.values, [](double value) { return value != 0; })) {
      unknown.push_back(quotable(name));
    }
  }
  return unknown;
}

std::string CalibrationNames::taken(Value value, std::string_view label) {
  std::string text;
  for (const std::string_view name : names_of(value).names) {
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", name, label);
  }
  return text;
}

std::string CalibrationNames::found_and_taken() const {
  constexpr std::size_t kShown = 12;
  std::vector<std::string> found;
  for (const auto& [name, entry] : entries_) {
    found.push_back(quotable(name));
  }
  const bool has_more = found.size() > kShown;
  found.resize(std::min(found.size(), kShown));
  return fmt::format(
      "it has {}{}; expected one of {}, likewise {}; {} and {} (with 1 and 2, left and "
      "right, L and R, or cam0 and cam1, before or after; case, _ and . do not matter)",
      found.empty() ? "no names" : fmt::format("{}", fmt::join(found, ", ")),
      has_more ? ", ..." : "", taken(Value::kMatrix, "1"), taken(Value::kDistortion, "1"),
      taken(Value::kRotation, ""), taken(Value::kTranslation, ""));
}

}  // namespace vantage
