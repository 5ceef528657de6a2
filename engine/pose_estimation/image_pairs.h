#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/pose_estimation/pair_geometry.h"
#include "engine/rectification/camera.h"
#include "engine/rectification/image_features.h"

namespace vantage {

/// Told after each piece of work of a step.
using StepProgress = std::function<void(std::string_view step, int done, int total)>;

/// Calls body(i) for each i below `count`, concurrently, and tells the progress of the step, one
/// call at a time.
void for_each_piece(std::string_view step, std::size_t count, const StepProgress& progress,
                    Execution& execution, const std::function<void(std::size_t)>& body);

/// Positions in photographs of one lens from the principal point, without distortion, in pixels of
/// fx.
class LensPositions {
 public:
  /// `lens`: empty where it is not known; the principal point is then the middle of the image and
  /// positions keep their distortion.
  LensPositions(const std::optional<Camera>& lens, int width_px, int height_px);

  /// Empty where the lens has no ray.
  [[nodiscard]] std::optional<Eigen::Vector2d> of(const Eigen::Vector2d& pixel) const;
  /// fx; empty where it is not known.
  [[nodiscard]] std::optional<double> focal_px() const;

 private:
  std::optional<LensModel> model_;
  std::optional<double> focal_px_;
  Eigen::Vector2d centre_px_;
};

/// The matches of two images.
struct MatchedPair {
  int first = 0;
  int second = 0;
  std::vector<std::array<int, 2>> features;
  std::vector<PointMatch> positions;  ///< as LensPositions tells them
};

/// Matches every image with those that share most of its strongest features, `partners` at most,
/// and with the next one; all pairs of up to partners + 1 images. In the order of the images.
std::vector<MatchedPair> match_image_pairs(const std::vector<ImageFeatures>& images,
                                           const LensPositions& positions, int partners,
                                           const StepProgress& progress, Execution& execution);

/// The focal length that the epipolar geometries of the pairs agree with best; of images with a
/// longer side of `side_px`, from 0.5 to 4 times that, nearer to 1.2 times where they do not tell.
double focal_length_of(const std::vector<MatchedPair>& pairs, double side_px, Execution& execution);

}  // namespace vantage
