#include "engine/generation/scene_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// 0 below −1, 1 above 1, smooth in between.
double soft_step(double x) {
  const double t = std::clamp((x + 1) / 2, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

class WavyWall final : public Surface {
 public:
  WavyWall(CentreView centre, double near_z, double far_z)
      : centre_(centre),
        near_z_(near_z),
        far_z_(far_z),
        amplitude_x_(0.35 * (far_z - near_z)),
        amplitude_y_(0.15 * (far_z - near_z)),
        wave_number_x_(2 * std::numbers::pi / (0.55 * far_z)),
        wave_number_y_(2 * std::numbers::pi / (0.7 * far_z)) {}

  // Newton's method on depth minus wall, bracketed by the two extreme depths.
  [[nodiscard]] double intersect(const Ray& ray) const override {
    if (ray.direction.z() <= 0) {
      return kNoHit;
    }
    double low = (near_z_ - ray.origin.z()) / ray.direction.z();
    double high = (far_z_ - ray.origin.z()) / ray.direction.z();
    double t = (low + high) / 2;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const Wave wave = wave_at(ray.at(t));
      const double excess = ray.origin.z() + t * ray.direction.z() - wave.z;
      (excess > 0 ? high : low) = t;
      const double slope =
          ray.direction.z() - wave.dz_dx * ray.direction.x() - wave.dz_dy * ray.direction.y();
      double next = t - excess / slope;
      if (!(next >= low && next <= high)) {
        next = (low + high) / 2;
      }
      const double step = next - t;
      t = next;
      if (std::abs(step) <= kRelativeStep * t) {
        break;
      }
    }
    return t > 0 ? t : kNoHit;
  }

  [[nodiscard]] SurfaceDetail detail(const Vector3d& point) const override {
    const Wave wave = wave_at(point);
    return {.normal = Vector3d(wave.dz_dx, wave.dz_dy, -1).normalized(),
            .texture = centre_.image_position(point),
            .pattern = lozenges(point)};
  }

 private:
  [[nodiscard]] double lozenges(const Vector3d& point) const {
    const double x = 20 * point.x() / far_z_;
    const double y = 14 * point.y() / far_z_;
    return soft_step(5 * std::sin(x + y) * std::sin(x - y));
  }

  struct Wave {
    double z, dz_dx, dz_dy;
  };
  static constexpr int kMaxIterations = 60;
  // Newton's next step is about the square of this one: below rounding.
  static constexpr double kRelativeStep = 1e-9;

  [[nodiscard]] Wave wave_at(const Vector3d& point) const {
    const double x = wave_number_x_ * point.x();
    const double y = wave_number_y_ * point.y() + 0.7;
    return {(near_z_ + far_z_) / 2 + amplitude_x_ * std::sin(x) + amplitude_y_ * std::sin(y),
            amplitude_x_ * wave_number_x_ * std::cos(x),
            amplitude_y_ * wave_number_y_ * std::cos(y)};
  }

  CentreView centre_;
  double near_z_, far_z_;
  double amplitude_x_, amplitude_y_;
  double wave_number_x_, wave_number_y_;
};

class Floor final : public Surface {
 public:
  Floor(CentreView centre, double d0, double du, double dv, double tile_size,
        std::vector<Ball> shadows)
      : centre_(centre),
        normal_(centre.focal_length_px * Vector3d(du, dv, 0) + d0 * Vector3d::UnitZ()),
        offset_(centre.focal_length_px + 0.5 * normal_.x()),
        tile_size_(tile_size),
        shadows_(std::move(shadows)) {}

  // With u = f (X - 1/2)/Z and v = f Y/Z the plane is d0 Z + du f (X - 1/2) + dv f Y = f.
  [[nodiscard]] double intersect(const Ray& ray) const override {
    const double approach = normal_.dot(ray.direction);
    const double t = (offset_ - normal_.dot(ray.origin)) / approach;
    return t > 0 && std::isfinite(t) ? t : kNoHit;
  }

  [[nodiscard]] SurfaceDetail detail(const Vector3d& point) const override {
    double light = 1;
    for (const Ball& ball : shadows_) {
      const double distance = std::hypot(point.x() - ball.centre.x(), point.z() - ball.centre.z());
      light *= 1 - 0.55 * std::exp(-distance * distance / (ball.radius * ball.radius));
    }
    return {.normal = -normal_.normalized(),  // upward
            .texture = centre_.image_position(point),
            .pattern = tiles(point),
            .light = light};
  }

 private:
  // A chequerboard with edges a few pixels wide at the point's depth.
  [[nodiscard]] double tiles(const Vector3d& point) const {
    const double softness = 2.5 * point.z() / centre_.focal_length_px;
    const auto wave = [&](double position, double stretch) {
      const double phase = std::numbers::pi * position / tile_size_;
      return std::clamp(std::sin(phase) * tile_size_ / (std::numbers::pi * softness * stretch),
                        -1.0, 1.0);
    };
    // Depth is foreshortened, so edges across it must be softer.
    return soft_step(wave(point.x(), 1) * wave(point.z(), 6));
  }

  CentreView centre_;
  Vector3d normal_;
  double offset_;
  double tile_size_;
  std::vector<Ball> shadows_;
};

// Smaller positive root of a t² + 2 b t + c = 0, a > 0.
double first_root(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) {
    return kNoHit;
  }
  const double root = std::sqrt(discriminant);
  const double near = (-b - root) / a;
  const double far = (-b + root) / a;
  return near > 0 ? near : far > 0 ? far : kNoHit;
}

class Sphere final : public Surface {
 public:
  Sphere(const Ball& ball, Eigen::Matrix3d rotation, double texture_scale, double stripes)
      : ball_(ball),
        rotation_(std::move(rotation)),
        texture_scale_(texture_scale),
        stripes_(stripes) {}

  [[nodiscard]] double intersect(const Ray& ray) const override {
    const Vector3d from_centre = ray.origin - ball_.centre;
    return first_root(ray.direction.squaredNorm(), from_centre.dot(ray.direction),
                      from_centre.squaredNorm() - ball_.radius * ball_.radius);
  }

  [[nodiscard]] SurfaceDetail detail(const Vector3d& point) const override {
    const Vector3d outward = (point - ball_.centre) / ball_.radius;
    const Vector3d local = rotation_.transpose() * outward;
    return {.normal = outward,
            .texture = local * (ball_.radius * texture_scale_),
            .pattern = soft_step(6 * std::sin(stripes_ * local.y()))};
  }

  [[nodiscard]] Ball bounds() const override { return ball_; }

 private:
  Ball ball_;
  Eigen::Matrix3d rotation_;
  double texture_scale_;
  double stripes_;
};

class Column final : public Surface {
 public:
  Column(const Vector3d& centre, double radius, double texture_scale)
      : centre_(centre.x(), centre.z()), radius_(radius), texture_scale_(texture_scale) {}

  [[nodiscard]] double intersect(const Ray& ray) const override {
    const Vector2d direction(ray.direction.x(), ray.direction.z());
    const Vector2d from_centre = Vector2d(ray.origin.x(), ray.origin.z()) - centre_;
    return first_root(direction.squaredNorm(), from_centre.dot(direction),
                      from_centre.squaredNorm() - radius_ * radius_);
  }

  [[nodiscard]] SurfaceDetail detail(const Vector3d& point) const override {
    const Vector3d outward(point.x() - centre_.x(), 0, point.z() - centre_.y());
    const double turns = std::atan2(outward.x(), -outward.z()) / (2 * std::numbers::pi);
    return {.normal = outward / radius_,
            .texture = texture_scale_ * Vector3d(outward.x(), point.y(), outward.z()),
            .pattern = soft_step(
                4 * std::sin(2 * std::numbers::pi * (2 * turns + point.y() / (5 * radius_))))};
  }

 private:
  Vector2d centre_;  // x and z of the axis
  double radius_;
  double texture_scale_;
};

bool is_inside(Outline outline, double s, double t) {
  const double radius = std::hypot(s, t);
  switch (outline) {
    case Outline::kRectangle:
      return std::abs(s) <= 1 && std::abs(t) <= 1;
    case Outline::kStar:
      return radius <= 0.72 - 0.28 * std::sin(5 * std::atan2(t, s));
    case Outline::kFlower:
      return radius <= 0.8 + 0.2 * std::cos(7 * std::atan2(t, s));
    case Outline::kRing:
      return radius <= 1 && radius >= 0.55;
  }
  return false;
}

class CardSurface final : public Surface {
 public:
  explicit CardSurface(const Card& card) : card_(card) {}

  [[nodiscard]] double intersect(const Ray& ray) const override {
    const Vector3d normal = card_.rotation.col(2);
    const double t = normal.dot(card_.centre - ray.origin) / normal.dot(ray.direction);
    if (!(t > 0) || !std::isfinite(t)) {
      return kNoHit;
    }
    const Vector3d local = card_.rotation.transpose() * (ray.at(t) - card_.centre);
    return is_inside(card_.outline, local.x() / card_.half_width, local.y() / card_.half_height)
               ? t
               : kNoHit;
  }

  [[nodiscard]] SurfaceDetail detail(const Vector3d& point) const override {
    const Vector3d local = card_.rotation.transpose() * (point - card_.centre);
    const double radius = std::hypot(local.x() / card_.half_width, local.y() / card_.half_height);
    // The whole card is lit on the side that faces the middle of the baseline.
    const Vector3d normal = card_.rotation.col(2);
    const bool faces_away = normal.dot(Vector3d(0.5, 0, 0) - card_.centre) < 0;
    return {.normal = faces_away ? Vector3d(-normal) : normal,
            .texture = Vector3d(local.x() * card_.texture_scale, local.y() * card_.texture_scale,
                                card_.texture_origin),
            .pattern = soft_step(10 * std::sin(9 * radius)),
            .is_uniform = std::abs(local.x()) < card_.uniform_share * card_.half_width &&
                          std::abs(local.y()) < card_.uniform_share * card_.half_height};
  }

  [[nodiscard]] Ball bounds() const override {
    return {card_.centre, std::hypot(card_.half_width, card_.half_height)};
  }

 private:
  Card card_;
};

}  // namespace

std::unique_ptr<Surface> make_wavy_wall(CentreView centre, double near_z, double far_z) {
  return std::make_unique<WavyWall>(centre, near_z, far_z);
}

std::unique_ptr<Surface> make_floor(CentreView centre, double d0, double du, double dv,
                                    double tile_size, std::vector<Ball> shadows) {
  return std::make_unique<Floor>(centre, d0, du, dv, tile_size, std::move(shadows));
}

std::unique_ptr<Surface> make_sphere(const Ball& ball, const Eigen::Matrix3d& rotation,
                                     double texture_scale, double stripes) {
  return std::make_unique<Sphere>(ball, rotation, texture_scale, stripes);
}

std::unique_ptr<Surface> make_column(const Vector3d& centre, double radius, double texture_scale) {
  return std::make_unique<Column>(centre, radius, texture_scale);
}

std::unique_ptr<Surface> make_card(const Card& card) { return std::make_unique<CardSurface>(card); }

}  // namespace vantage
