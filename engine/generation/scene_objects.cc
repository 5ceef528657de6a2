#include "engine/generation/scene_objects.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Positions are laid out in the centre view, in fractions of the image, so that images of any size
// show the same scene; depths in fractions of the range from the far to the near disparity.
class Composer {
 public:
  Composer(const LayeredSceneOptions& options, CentreView centre, int frame)
      : width_(options.width_px),
        height_(options.height_px),
        side_(std::min(options.width_px, options.height_px)),
        far_(options.far_disparity_or_default()),
        range_(options.near_disparity_or_default() - far_),
        has_boards_(options.has_boards),
        centre_(centre),
        cycle_(2 * std::numbers::pi * (frame % options.frames_per_cycle) /
               options.frames_per_cycle) {}

  std::vector<SceneObject> compose() {
    if (has_boards_) {
      add_column();
      add_boards();
    } else {
      add_spheres();
      add_column();
      add_cards();
      add_bars();
    }
    add_room();
    return std::move(objects_);
  }

 private:
  // −1..1, `turns` oscillations per cycle.
  [[nodiscard]] double sway(int turns, double phase) const {
    return std::sin(turns * cycle_ + phase);
  }
  [[nodiscard]] double disparity(double nearness) const { return far_ + nearness * range_; }
  [[nodiscard]] Vector3d place(double u, double v, double nearness) const {
    return centre_.world(u * width_, v * height_, disparity(nearness));
  }
  // Length of an object that appears `fraction` of the image's shorter side long.
  [[nodiscard]] double length(double fraction, double nearness) const {
    return fraction * side_ / disparity(nearness);
  }

  void add(std::unique_ptr<const Surface> surface, Palette palette) {
    objects_.push_back({std::move(surface), std::move(palette)});
  }

  void add_sphere(double u, double v, double nearness, double radius, const Matrix3d& rotation,
                  double stripes, Palette palette) {
    const Ball ball{place(u, v, nearness), length(radius, nearness)};
    balls_.push_back(ball);
    add(make_sphere(ball, rotation, disparity(nearness), stripes), std::move(palette));
  }

  void add_spheres() {
    const Vector3d tilted = Vector3d(0.3, 1, 0.2).normalized();
    const Vector3d across = Vector3d(1, 0.2, 0.4).normalized();
    add_sphere(
        0.17 + 0.05 * sway(1, 0), 0.13, 0.42, 0.17,
        Matrix3d(AngleAxisd(0.5 + 0.5 * sway(1, 0), Vector3d::UnitZ()) * AngleAxisd(0.4, across)),
        5, {{206, 84, 62}, {226, 138, 72}, {240, 222, 190}, {226, 196, 150}});
    add_sphere(-0.16 + 0.1 * sway(1, 1.2), 0.1 + 0.06 * sway(2, 0.4),
               0.3 + 0.1 * sway(1, 1.2 + std::numbers::pi / 2), 0.085,
               Matrix3d(AngleAxisd(cycle_, tilted)), 7,
               {{52, 112, 176}, {74, 156, 196}, {226, 232, 226}, {180, 206, 214}});
  }

  void add_column() {
    constexpr double kNearness = 0.22;
    add(make_column(place(-0.36, 0, kNearness), length(0.075, kNearness), disparity(kNearness)),
        {{214, 204, 186}, {188, 170, 148}, {118, 142, 126}, {92, 116, 110}});
  }

  void add_card(Outline outline, double u, double v, double nearness, double half_side,
                const Matrix3d& rotation, Palette palette, double uniform_share = 0) {
    add(make_card({.outline = outline,
                   .centre = place(u, v, nearness),
                   .rotation = rotation,
                   .half_width = length(half_side, nearness),
                   .half_height = length(half_side, nearness),
                   .texture_scale = disparity(nearness),
                   .texture_origin = 211.0 * static_cast<double>(objects_.size()),
                   .uniform_share = uniform_share}),
        std::move(palette));
  }

  static Matrix3d turned(double yaw, double pitch, double roll) {
    return Matrix3d(AngleAxisd(yaw, Vector3d::UnitY()) * AngleAxisd(pitch, Vector3d::UnitX()) *
                    AngleAxisd(roll, Vector3d::UnitZ()));
  }

  void add_boards() {
    add_card(Outline::kRectangle, -0.2, -0.24 + 0.02 * sway(1, 2), 0.35, 0.19, turned(0, 0, 0.1),
             {{236, 188, 62}, {220, 146, 48}, {248, 222, 130}, {236, 196, 90}}, 1);
    add_card(Outline::kRectangle, 0.24 + 0.02 * sway(1, 3), -0.22, 0.45, 0.23,
             turned(-0.8 + 0.1 * sway(1, 2.5), 0, 0),
             {{170, 82, 138}, {206, 116, 154}, {240, 190, 176}, {226, 158, 166}}, 0.8);
    add_card(Outline::kRectangle, -0.24 + 0.02 * sway(1, 4), 0.23, 0.6, 0.2, turned(0, 0, -0.1),
             {{70, 150, 118}, {112, 178, 120}, {190, 208, 140}, {150, 190, 132}}, 0.8);
    add_card(Outline::kRectangle, 0.22, 0.22, 0.5, 0.22, turned(0.3, 0.8 + 0.1 * sway(1, 1), 0),
             {{52, 112, 176}, {74, 156, 196}, {226, 232, 226}, {180, 206, 214}}, 1);
  }

  void add_cards() {
    add_card(Outline::kStar, -0.14, -0.24 + 0.02 * sway(1, 2), 0.5, 0.19,
             turned(0.75 + 0.2 * sway(1, 0.5), 0.15, 0.3 * sway(1, 1)),
             {{236, 188, 62}, {220, 146, 48}, {248, 222, 130}, {236, 196, 90}});
    add_card(Outline::kFlower, 0.36 + 0.02 * sway(1, 3), -0.2, 0.5, 0.17,
             turned(-0.6 + 0.2 * sway(1, 2.5), -0.2, 0.5 + 0.4 * sway(1, 0)),
             {{170, 82, 138}, {206, 116, 154}, {240, 190, 176}, {226, 158, 166}});
    add_card(Outline::kRing, -0.3 + 0.02 * sway(1, 4), 0.27, 0.62, 0.16,
             turned(0.3 * sway(1, 1.5), 0.85, 0.4),
             {{70, 150, 118}, {112, 178, 120}, {190, 208, 140}, {150, 190, 132}});
  }

  void add_bars() {
    for (int i = 0; i < 3; ++i) {
      const double nearness = 0.8 + 0.05 * i;
      const Matrix3d rotation(AngleAxisd(0.3, Vector3d::UnitY()) *
                              AngleAxisd(-0.12 + 0.03 * sway(1, 0.8 * i), Vector3d::UnitZ()));
      add(make_card({.outline = Outline::kRectangle,
                     .centre = place(0.045 + 0.055 * i, -0.3, nearness),
                     .rotation = rotation,
                     .half_width = length(0.006, nearness),
                     .half_height = length(0.24 - 0.04 * i, nearness),
                     .texture_scale = disparity(nearness),
                     .texture_origin = 211.0 * static_cast<double>(objects_.size())}),
          {{108, 66, 48}, {142, 92, 58}, {128, 82, 56}, {164, 112, 70}});
    }
  }

  void add_room() {
    // The floor meets the wall above its lower quarter and ends midway to the near disparity.
    constexpr double kHorizon = 0.14;
    const double at_wall = disparity(0) * 1.1;
    const double dv = (disparity(0.55) - at_wall) / ((0.5 - kHorizon) * height_);
    const double du = 0.05 * range_ / width_;
    add(make_floor(centre_, at_wall - dv * kHorizon * height_, du, dv, length(0.16, 0.2), balls_),
        {{146, 102, 72}, {124, 84, 58}, {226, 200, 164}, {206, 176, 138}});
    const double farthest = centre_.focal_length_px / far_;
    add(make_wavy_wall(centre_, farthest / 1.18, farthest / 1.02),
        {{112, 144, 164}, {84, 120, 148}, {158, 182, 184}, {130, 162, 176}});
  }

  double width_, height_, side_;
  double far_, range_;
  bool has_boards_;
  CentreView centre_;
  double cycle_;
  std::vector<Ball> balls_;
  std::vector<SceneObject> objects_;
};

}  // namespace

std::vector<SceneObject> compose_scene(const LayeredSceneOptions& options, CentreView centre,
                                       int frame) {
  return Composer(options, centre, frame).compose();
}

}  // namespace vantage
