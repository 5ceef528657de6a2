// Quality of views of a generated scene from exact maps, for cameras that are rotated, rolled,
// zoomed, in front of and behind the baseline: in one pass and in the book's three steps, PSNR in
// dB. The tables are in docs/VIEWS.md.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/warped_photograph.h"

namespace vantage::perf {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// Angles in degrees; position in baselines from the left camera.
struct Place {
  Eigen::Vector3d centre{0, 0, 0};
  double roll = 0;
  double yaw = 0;
  double pitch = 0;
  double zoom = 1;

  [[nodiscard]] std::string text() const {
    return fmt::format("({}, {}, {}), roll {}, yaw {}, pitch {}, zoom {}", centre.x(), centre.y(),
                       centre.z(), roll, yaw, pitch, zoom);
  }
};

const std::vector<Place>& places_at_a_camera() {
  static const std::vector<Place> places = {{.zoom = 0.5},
                                            {.zoom = 0.6},
                                            {.zoom = 0.7},
                                            {.zoom = 0.8},
                                            {.zoom = 0.9},
                                            {.zoom = 1.5},
                                            {.zoom = 2},
                                            {.zoom = 3},
                                            {.yaw = 10},
                                            {.yaw = 20},
                                            {.yaw = 30},
                                            {.pitch = 20},
                                            {.roll = 5},
                                            {.pitch = -30},
                                            {.roll = 30},
                                            {.roll = 45},
                                            {.roll = 20, .zoom = 2},
                                            {.roll = 20, .zoom = 0.5},
                                            {.roll = 20, .yaw = 30, .zoom = 3},
                                            {.yaw = 20, .pitch = 10, .zoom = 0.7}};
  return places;
}

const std::vector<Place>& places_elsewhere() {
  static const std::vector<Place> places = {{.centre = {0.5, 0.3, 0}},
                                            {.centre = {-0.3, 0.2, 0}},
                                            {.centre = {0.5, 0, 0}, .yaw = 5.7, .pitch = 2.9},
                                            {.centre = {0.5, 0, 0}, .yaw = 20},
                                            {.centre = {0.5, 0.2, 0}, .roll = 30},
                                            {.centre = {0.5, 0.2, 0}, .roll = 90},
                                            {.centre = {0.5, 0.1, 1.5}},
                                            {.centre = {0.5, 0.1, -1.5}},
                                            {.centre = {0.5, 0.1, -8}},
                                            {.centre = {0.5, 0, 0}, .zoom = 0.5},
                                            {.centre = {0.5, 0, 0}, .zoom = 0.7},
                                            {.centre = {0.5, 0, 0}, .zoom = 0.9},
                                            {.centre = {0.5, 0, 0}, .zoom = 2},
                                            {.centre = {0.5, 0, 0}, .zoom = 3},
                                            {.centre = {0.5, 0, 0}, .yaw = 30, .zoom = 0.6},
                                            {.centre = {0.5, 0.3, 0}, .zoom = 1.5},
                                            {.centre = {0.25, 0.1, 0}, .roll = 10, .zoom = 2},
                                            {.centre = {0.25, -0.5, 0}, .yaw = 10, .zoom = 3},
                                            {.centre = {0.01, 0, 0}, .zoom = 2}};
  return places;
}

class PosedViews {
 public:
  PosedViews() {
    pair_.width_px = kWidth;
    pair_.height_px = kHeight;
    pair_.left.matrix = pair_.right.matrix = scene_.camera({0, 0}).matrix;
    pair_.baseline = 1;
  }

  void print_at_a_camera() {
    fmt::print("{:<62}{:>10}{:>12}   against the rendered picture\n", "at the left camera",
               "one pass", "three steps");
    for (const Place& place : places_at_a_camera()) {
      const PosedCamera camera = camera_at(place);
      const Eigen::Matrix3d homography =
          camera.matrix * camera.rotation * pair_.left.matrix.inverse();
      const Photograph truth =
          test::warped(left_.image, homography, place.zoom < 1 ? 8 : 1, cv::BORDER_REPLICATE);
      const Photograph rendered = scene_.render(camera, 0).image;
      const Mask mask = inside(homography, place.zoom);
      const auto [one_pass, three_steps] = views_of(camera);
      fmt::print("{:<62}{:>10.2f}{:>12.2f}{:>10.2f}{:>12.2f}\n", place.text(),
                 psnr(one_pass, truth, mask), psnr(three_steps, truth, mask),
                 psnr(one_pass, rendered, mask), psnr(three_steps, rendered, mask));
    }
  }

  void print_elsewhere() {
    fmt::print("\n{:<62}{:>10}{:>12}\n", "elsewhere", "one pass", "three steps");
    for (const Place& place : places_elsewhere()) {
      const PosedCamera camera = camera_at(place);
      const SceneRendering truth = scene_.render(camera, 0);
      const Mask not_left = scene_.occlusion(camera, scene_.camera({0, 0}), 0);
      const Mask not_right = scene_.occlusion(camera, scene_.camera({1, 0}), 0);
      Mask seen(kWidth, kHeight);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const bool is_seen = not_left.at(x, y) == 0 || not_right.at(x, y) == 0;
          seen.at(x, y) = is_seen && std::isfinite(truth.disparity.at(x, y)) ? 255 : 0;
        }
      }
      const auto [one_pass, three_steps] = views_of(camera);
      fmt::print("{:<62}{:>10.2f}{:>12.2f}\n", place.text(), psnr(one_pass, truth.image, seen),
                 psnr(three_steps, truth.image, seen));
    }
  }

 private:
  [[nodiscard]] PosedCamera camera_at(const Place& place) const {
    constexpr double kDegree = std::numbers::pi / 180;
    PosedCamera camera = scene_.camera({0, 0});
    camera.matrix.topLeftCorner<2, 2>() *= place.zoom;
    camera.rotation = (Eigen::AngleAxisd(place.roll * kDegree, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(place.yaw * kDegree, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(place.pitch * kDegree, Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
    camera.translation = -camera.rotation * place.centre;
    return camera;
  }

  /// Views in one pass and in three steps; the latter has no image if its plane cuts the scene.
  [[nodiscard]] std::pair<SynthesizedView, SynthesizedView> views_of(const PosedCamera& camera) {
    std::pair<SynthesizedView, SynthesizedView> views;
    ViewSynthesizer({}, execution_)
        .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()},
                    camera_view(pair_, camera), views.first);
    try {
      ThreeStepSynthesizer({}, execution_)
          .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()},
                      pair_, camera, views.second);
    } catch (const Error&) {
      views.second = {};
    }
    return views;
  }

  [[nodiscard]] double psnr(const SynthesizedView& view, const Photograph& truth,
                            const Mask& mask) {
    return view.image.width() == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : evaluate_view(view.image, truth, execution_,
                                                   ImageView<const std::uint8_t>(mask.view()))
                                         .psnr_db;
  }

  /// Mask of the view's pixels that lie inside the photograph.
  static Mask inside(const Eigen::Matrix3d& homography, double zoom) {
    const Eigen::Matrix3d back = homography.inverse();
    const double border = zoom < 1 ? 1 / zoom : 0;
    Mask mask(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Eigen::Vector3d at = back * Eigen::Vector3d(x, y, 1);
        const Eigen::Vector2d place = at.hnormalized();
        const bool is_inside = at.z() > 0 && place.minCoeff() >= border &&
                               place.x() <= kWidth - 1 - border &&
                               place.y() <= kHeight - 1 - border;
        mask.at(x, y) = is_inside ? 255 : 0;
      }
    }
    return mask;
  }

  Execution execution_{{}};
  LayeredScene scene_{{.width_px = kWidth, .height_px = kHeight}, execution_};
  SceneRendering left_ = scene_.render(SceneView{0, 0}, 0);
  SceneRendering right_ = scene_.render(SceneView{1, 0}, 0);
  RectifiedPair pair_;
};

}  // namespace
}  // namespace vantage::perf

int main() {
  vantage::perf::PosedViews views;
  views.print_at_a_camera();
  views.print_elsewhere();
}
