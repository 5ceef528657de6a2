#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/calibration/calibration_entries.h"

namespace vantage {

/// What the entries of calibrations mean.
enum class CalibrationValue {
  kMatrix,         ///< K: 3×3, or fx fy cx cy
  kDistortion,     ///< D
  kLensModel,      ///< the kind of D: a word, or a switch of its name
  kRectification,  ///< rectified frame ← camera: R1 of OpenCV
  kProjection,     ///< 3×4, rectified pixel ← rectified frame: P1 of OpenCV
  kImageSize,      ///< width and height
  kImageWidth,
  kImageHeight,
  kFx,
  kFy,
  kCx,
  kCy,
  kFromPrevious,  ///< 4×4, this camera ← the one before: T_cn_cnm1 of Kalibr
  kPoseInBody,    ///< 4×4, body ← camera: T_BS of EuRoC
  kFromBody,      ///< 4×4, camera ← body: T_cam_imu of Kalibr
  kRotation,      ///< R: right camera ← left one
  kTranslation,   ///< T: likewise
  kFromRight,     ///< 4×4 or 3×4, left camera ← right one: T_c1_c2 of ORB-SLAM
  kDepthMatrix,   ///< Q
  kBaseline,
  kFocalBaseline,  ///< focal length · baseline: Camera.bf of ORB-SLAM
  kMetresPerUnit,
};

/// One of two cameras, as names tell them apart; kNone for what is not of one of them.
enum class CameraLabel { kNone, kFirst, kSecond };

/// The entries of files, by meaning. Names are compared without case and separators (_ - .), so
/// K_left, leftK and left: {K: …} are one; names of nodes around an entry may be left out, unless
/// they tell the camera. Thread rule: one thread.
class CalibrationNames {
 public:
  /// Numbers the cameras by what the file has: left and right, 1 and 2, or 0 and 1.
  explicit CalibrationNames(CalibrationEntries entries);

  struct Found {
    std::string name;                         ///< as the file has it
    const CalibrationEntry* entry = nullptr;  ///< null: there is none
  };
  /// Whether what belongs to both cameras counts for one that has none of its own.
  enum class Sharing { kOwn, kShared };
  /// The first entry with one of the value's names, and of a camera. Single numbers and matrices do
  /// not stand for each other: k1 is a coefficient or a matrix.
  [[nodiscard]] Found find(CalibrationValue value, CameraLabel camera = CameraLabel::kNone,
                           Sharing sharing = Sharing::kShared) const;
  /// All of them, the camera's own first.
  [[nodiscard]] std::vector<Found> all(CalibrationValue value, CameraLabel camera,
                                       Sharing sharing = Sharing::kShared) const;
  [[nodiscard]] bool has(CalibrationValue value) const { return find(value).entry != nullptr; }
  /// A coefficient of the lens (k1, k2, p1, p2, k3 …) in an entry of its own; null if there is
  /// none.
  [[nodiscard]] const CalibrationEntry* coefficient(std::string_view name,
                                                    CameraLabel camera) const;

  /// Entries that look like distortion, hold other numbers than 0, and are not found under any
  /// name.
  [[nodiscard]] std::vector<std::string> unknown_distortions() const;

  /// Whether cameras are numbered from 0.
  [[nodiscard]] bool counts_from_0() const { return labels_ == &kFromZero; }
  /// Names of the entries, and the names that are taken, for messages: "it has …; expected …".
  [[nodiscard]] std::string found_and_taken() const;
  /// The names of a value, with a camera's label, for messages.
  [[nodiscard]] static std::string taken(CalibrationValue value, std::string_view label);
  [[nodiscard]] const CalibrationEntries& entries() const { return entries_; }

 private:
  using Labels = std::array<std::vector<std::string_view>, 2>;
  static const Labels kSides;
  static const Labels kFromOne;
  static const Labels kFromZero;

  template <typename Fits>
  [[nodiscard]] Found find_named(std::string_view name, CameraLabel camera, const Fits& fits) const;
  [[nodiscard]] static bool is_label(std::string_view name);

  CalibrationEntries entries_;
  std::map<std::string, std::string, std::less<>> by_spelling_;  // name in the file, by its letters
  const Labels* labels_ = &kSides;
};

}  // namespace vantage
