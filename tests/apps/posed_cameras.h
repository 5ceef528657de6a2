#pragma once

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <numbers>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/io/images/photograph_io.h"
#include "tests/apps/vantage_process.h"

namespace vantage {

/// Four hand-held cameras about a square, turned by some degrees, and what they see in DIR/images.
class PosedCameras : public testing::Test {
 protected:
  static LayeredSceneOptions small_scene(int width_px, int height_px) {
    return {.width_px = width_px, .height_px = height_px, .samples_per_side = 2};
  }
  /// About the axes x, y and z together, in degrees.
  static Eigen::Matrix3d turn(double x, double y, double z) {
    constexpr double kDegree = std::numbers::pi / 180;
    const Eigen::Vector3d radians = Eigen::Vector3d(x, y, z) * kDegree;
    return Eigen::AngleAxisd(radians.norm(), radians.normalized()).toRotationMatrix();
  }

  PosedCameras(int width_px, int height_px) : scene_(small_scene(width_px, height_px), execution_) {
    fs::create_directory(images_);
    cameras_ = {camera({0, 0, 0.05}, turn(0.5, -0.8, 2)), camera({1, 0.1, 0}, turn(-0.4, 0.6, -3)),
                camera({0.1, 0.9, -0.1}, turn(0.7, 0.3, 1)),
                camera({0.9, 1, 0.1}, turn(-0.6, -0.5, 4))};
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      write_photograph(fmt::format("{}/{}.png", images_, i), truth(cameras_[i]));
    }
  }

  [[nodiscard]] PosedCamera camera(const Eigen::Vector3d& centre,
                                   const Eigen::Matrix3d& rotation) const {
    PosedCamera made = scene_.camera({});
    made.rotation = rotation;
    made.translation = -rotation * centre;
    return made;
  }
  [[nodiscard]] Photograph truth(const PosedCamera& at) const { return scene_.render(at, 0).image; }
  [[nodiscard]] double psnr(const std::string& file, const PosedCamera& at) const {
    return evaluate_view(read_photograph(file), truth(at), execution_).psnr_db;
  }

  /// "fx fy cx cy", as --intrinsics takes it.
  void write_lens(const std::string& file) const {
    const Eigen::Matrix3d& k = cameras_[0].matrix;
    write_file(file, fmt::format("{} {} {} {}\n", k(0, 0), k(1, 1), k(0, 2), k(1, 2)));
  }
  /// A view of `scene view --pose`.
  void write_pose(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) const {
    const Eigen::Matrix3d& k = cameras_[0].matrix;
    const nlohmann::json json = {
        {"view",
         {{{"K", {k(0, 0), 0, k(0, 2), 0, k(1, 1), k(1, 2), 0, 0, 1}},
           {"R", {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)}},
           {"t", {t.x(), t.y(), t.z()}}}}}};
    write_file(pose_, json.dump());
  }

  mutable Execution execution_{{.threads = 2}};
  LayeredScene scene_;
  TemporaryFolder folder_;
  std::string images_ = folder_ / "images";
  std::string model_ = folder_ / "model";
  std::string place_ = folder_ / "scene";
  std::string pose_ = folder_ / "pose.json";
  std::vector<PosedCamera> cameras_;
};

}  // namespace vantage
