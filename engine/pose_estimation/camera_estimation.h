#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/pose_estimation/feature_tracks.h"
#include "engine/pose_estimation/image_pairs.h"
#include "engine/rectification/camera.h"
#include "engine/rectification/camera_pose.h"

namespace vantage {

inline constexpr int kMaxEstimatedCameras = 500;

struct CameraEstimationOptions {
  std::optional<Camera> lens = std::nullopt;  ///< of all images; empty: estimated
  int partners = 12;                          ///< see match_image_pairs(); 1..100
  FeatureMatchOptions features = {};

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

struct EstimatedImage {
  std::optional<CameraPose> pose;  ///< empty: left out
  std::string problem;             ///< why
  int points = 0;                  ///< that it shows
  double rms_px = 0;               ///< of their distances from where they should be
};

struct EstimatedPair {
  int first = 0;
  int second = 0;
  int matches = 0;
  int inliers = 0;         ///< that agree with one pose of these two alone
  double off_degrees = 0;  ///< turn between that pose and the one of all images together
  std::string refusal;     ///< why the pair does not count; empty: it does
};

/// Cameras of all images in one world: the frame of the first one that has a pose. Its unit is the
/// median distance of a camera from the nearest one.
struct CameraEstimate {
  Camera lens;
  std::vector<EstimatedImage> images;
  std::vector<EstimatedPair> pairs;  ///< with at least kMinPairInliers matches
  std::vector<PointTrack> points;    ///< positions are those of LensPositions
  double start_median_px = 0;        ///< median error of all sightings, before the adjustment
  double median_px = 0;              ///< after it, without outliers, as the next
  double rms_px = 0;
  int sightings = 0;
  int outliers = 0;  ///< sightings left out on the way
};

/// Estimates the cameras of hand-held photographs of one lens and one size: features of all images
/// are matched pair by pair; turns of pairs are averaged, and pairs that contradict the others left
/// out; positions follow from points that several images show; then all is adjusted together
/// (adjust_bundle()). Deterministic.
///
/// `load`: the photograph of an image; called concurrently. `names`: of the images, for messages.
/// Throws Error for fewer than 2 images or more than kMaxEstimatedCameras, images of different
/// sizes, and where no two images can be joined, or show no parallax.
CameraEstimate estimate_cameras(const std::vector<std::string>& names,
                                const std::function<Photograph(int image)>& load,
                                const CameraEstimationOptions& options,
                                const StepProgress& progress, Execution& execution);

}  // namespace vantage
