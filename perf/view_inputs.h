#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "engine/generation/layered_scene.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/view_pose.h"
#include "perf/peers.h"

namespace vantage::perf {

/// A synthetic scene with a pair of photographs of it, and maps as matching them gives: with the
/// outlines, errors and filled pixels of maps of photographs.
struct SyntheticPair {
  LayeredScene geometry;  ///< unit of length: the baseline
  RectifiedPair cameras;
  Photograph left;
  Photograph right;
  DisparityMaps maps;
};

inline SyntheticPair make_synthetic_pair(int width, int height, bool is_grey,
                                         Execution& execution) {
  LayeredSceneOptions options;
  options.width_px = width;
  options.height_px = height;
  options.samples_per_side = 2;
  options.right_gain = 0.95;
  options.right_offset = 4;
  SyntheticPair scene{LayeredScene(options, execution), {}, {}, {}, {}};
  scene.left = scene.geometry.render(SceneView{0, 0}, 0).image;
  scene.right = scene.geometry.render(SceneView{1, 0}, 0).image;
  MatchOptions match;
  match.preset = MatchPreset::kBalanced;
  match.disparities = {static_cast<int>(options.far_disparity_or_default()),
                       static_cast<int>(std::ceil(options.near_disparity_or_default()))};
  StereoMatcher(match, execution).match(scene.left, scene.right, {}, scene.maps);
  if (is_grey) {
    scene.left = to_grey(scene.left);
    scene.right = to_grey(scene.right);
  }
  scene.cameras.width_px = width;
  scene.cameras.height_px = height;
  scene.cameras.baseline = 1;
  const Eigen::Matrix3d matrix = scene.geometry.camera({0, 0}).matrix;
  scene.cameras.left = {matrix, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
  scene.cameras.right = scene.cameras.left;
  return scene;
}

/// Camera position and orientation of a new view.
struct ViewPlace {
  std::string name;
  BaselinePosition position;
  double roll = 0;   ///< about the viewing direction, radians
  double yaw = 0;    ///< to the side
  double pitch = 0;  ///< down

  [[nodiscard]] bool is_turned() const { return roll != 0 || yaw != 0 || pitch != 0; }

  [[nodiscard]] PosedCamera camera(const SyntheticPair& scene) const {
    PosedCamera camera = scene.geometry.camera({position.x, position.y});
    const Eigen::Vector3d centre = camera.centre();
    camera.rotation = (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
                          .toRotationMatrix() *
                      camera.rotation;
    camera.translation = -camera.rotation * centre;
    return camera;
  }

  [[nodiscard]] NewView view(const SyntheticPair& scene) const {
    return is_turned()
               ? camera_view(scene.cameras, camera(scene))
               : baseline_view(position.x, position.y, scene.left.width(), scene.left.height());
  }
};

inline std::vector<ViewPlace> view_places() {
  return {{.name = "baseline, XS 0.5", .position = {0.5, 0}},
          {.name = "outside, XS 1.3", .position = {1.3, 0}},
          {.name = "above, XS 0.5, YS -0.3", .position = {0.5, -0.3}},
          {.name = "turned by 6 and 2 degrees", .position = {0.5, -0.2}, .yaw = 0.1, .pitch = 0.03},
          {.name = "rolled by half a radian", .position = {0.5, -0.2}, .roll = 0.5}};
}

/// The calls an OpenCV user needs when everything else is known: one bicubic cv::remap of each
/// photograph to the new view, with the exact positions of the view's pixels in the photographs.
class TwoRemaps {
 public:
  TwoRemaps(const SyntheticPair& scene, const ViewPlace& place) {
    const PosedCamera camera = place.camera(scene);
    const DisparityMap nearness = scene.geometry.render(camera, 0).disparity;
    for (const int side : {0, 1}) {
      sources_[static_cast<std::size_t>(side)] = to_opencv(side == 0 ? scene.left : scene.right);
      positions_[static_cast<std::size_t>(side)] =
          positions(scene.cameras, camera, nearness.view(), side);
      cv::convertMaps(positions_[static_cast<std::size_t>(side)], cv::noArray(),
                      fixed_[static_cast<std::size_t>(side)],
                      fractions_[static_cast<std::size_t>(side)], CV_16SC2);
    }
  }

  /// Positions as floats.
  void run_float() {
    for (std::size_t side = 0; side < 2; ++side) {
      cv::remap(sources_[side], views_[side], positions_[side], cv::noArray(), cv::INTER_CUBIC,
                cv::BORDER_REPLICATE);
    }
  }
  /// Positions as 32nds of a pixel, rounded beforehand: faster.
  void run_fixed() {
    for (std::size_t side = 0; side < 2; ++side) {
      cv::remap(sources_[side], views_[side], fixed_[side], fractions_[side], cv::INTER_CUBIC,
                cv::BORDER_REPLICATE);
    }
  }
  [[nodiscard]] const cv::Mat& remapped(std::size_t side) const { return views_[side]; }

 private:
  // nearness: disparities at the depths of `camera`; NaN where it looks past the scene.
  static cv::Mat positions(const RectifiedPair& pair, const PosedCamera& camera,
                           ImageView<const float> nearness, int side) {
    cv::Mat positions(nearness.height(), nearness.width(), CV_32FC2);
    const Eigen::Matrix3d back = camera.matrix.inverse();
    const double disparity_depth = pair.left.matrix(0, 0) * pair.baseline;
    for (int v = 0; v < nearness.height(); ++v) {
      for (int u = 0; u < nearness.width(); ++u) {
        const double depth = disparity_depth / double{nearness.row(v)[u]};
        const Eigen::Vector3d point =
            camera.rotation.transpose() *
            (depth * (back * Eigen::Vector3d(u, v, 1)) - camera.translation);
        const Eigen::Vector3d seen =
            pair.left.matrix * (point - Eigen::Vector3d(side * pair.baseline, 0, 0));
        const Eigen::Vector2d at = seen.hnormalized();
        positions.at<cv::Vec2f>(v, u) =
            at.allFinite() ? cv::Vec2f(static_cast<float>(at.x()), static_cast<float>(at.y()))
                           : cv::Vec2f(-1, -1);
      }
    }
    return positions;
  }

  std::array<cv::Mat, 2> sources_, positions_, fixed_, fractions_, views_;
};

}  // namespace vantage::perf
