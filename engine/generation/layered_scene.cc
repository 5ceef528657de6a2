#include "engine/generation/layered_scene.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/generation/option_range.h"
#include "engine/generation/portable_random.h"
#include "engine/generation/scene_objects.h"

namespace vantage {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxBaselines = 16;
// A point is occluded if a surface is hit before this fraction of the distance to it; the rest
// allows for rounding errors of the two rays.
constexpr double kVisibleShare = 1 - 1e-7;

// Rays and image positions of a camera.
class RayCaster {
 public:
  // Adding 0 removes −0, because noise is seeded with the bits of the position.
  explicit RayCaster(const PosedCamera& camera)
      : camera_(camera), position_(camera.centre() + Vector3d::Zero()) {}

  [[nodiscard]] const Vector3d& position() const { return position_; }
  // t is the depth of the point in the camera.
  [[nodiscard]] Ray ray_through(double x_px, double y_px) const {
    const Matrix3d& k = camera_.matrix;
    const double v = (y_px - k(1, 2)) / k(1, 1);
    const double u = (x_px - k(0, 2) - k(0, 1) * v) / k(0, 0);
    return {position_, camera_.rotation.transpose() * Vector3d(u, v, 1)};
  }
  /// Right, down and forward in the camera's frame.
  [[nodiscard]] Vector3d relative(const Vector3d& point) const {
    return camera_.rotation * (point - position_);
  }
  /// The image position of a point given by relative().
  [[nodiscard]] Vector2d project(const Vector3d& relative) const {
    return (camera_.matrix * (relative / relative.z())).head<2>();
  }
  [[nodiscard]] bool has_in_frame(const Vector2d& position) const {
    return position.x() >= -0.5 && position.x() < camera_.width_px - 0.5 && position.y() >= -0.5 &&
           position.y() < camera_.height_px - 0.5;
  }

 private:
  PosedCamera camera_;
  Vector3d position_;
};

struct Hit {
  double t = kNoHit;
  int object = 0;
};

// Image rectangle outside which a camera cannot see an object.
struct Box {
  Vector2d low, high;

  [[nodiscard]] bool contains(double x_px, double y_px) const {
    return x_px >= low.x() && x_px <= high.x() && y_px >= low.y() && y_px <= high.y();
  }
};

Box box_of(const Ball& ball, const RayCaster& camera) {
  const Vector3d centre = camera.relative(ball.centre);
  if (!(centre.z() > ball.radius)) {
    return {Vector2d::Constant(-kNoHit), Vector2d::Constant(kNoHit)};
  }
  Box box{Vector2d::Constant(kNoHit), Vector2d::Constant(-kNoHit)};
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign((corner & 1) * 2 - 1, (corner & 2) - 1, ((corner >> 1) & 2) - 1);
    const Vector2d position = camera.project(centre + ball.radius * sign);
    box.low = box.low.cwiseMin(position);
    box.high = box.high.cwiseMax(position);
  }
  return box;
}

// One camera and the scene at one time.
class Shot {
 public:
  Shot(const std::vector<SceneObject>& objects, const PosedCamera& camera)
      : objects_(objects), camera_(camera) {
    for (const SceneObject& object : objects_) {
      boxes_.push_back(box_of(object.surface->bounds(), camera_));
    }
  }

  [[nodiscard]] const RayCaster& camera() const { return camera_; }

  /// `ray` starts at the camera and passes through the image position.
  [[nodiscard]] Hit first_hit(const Ray& ray, double x_px, double y_px) const {
    Hit first;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!boxes_[i].contains(x_px, y_px)) {
        continue;
      }
      const double t = objects_[i].surface->intersect(ray);
      if (t < first.t) {
        first = {t, static_cast<int>(i)};
      }
    }
    return first;
  }

  /// Inside its frame and not occluded.
  [[nodiscard]] bool sees(const Vector3d& point) const {
    const Vector3d relative = camera_.relative(point);
    const Vector2d position = camera_.project(relative);
    if (!(relative.z() > 0) || !camera_.has_in_frame(position)) {
      return false;
    }
    const Ray ray{camera_.position(), point - camera_.position()};
    return first_hit(ray, position.x(), position.y()).t >= kVisibleShare;
  }

 private:
  const std::vector<SceneObject>& objects_;
  RayCaster camera_;
  std::vector<Box> boxes_;
};

}  // namespace

struct LayeredScene::Content {
  explicit Content(const LayeredSceneOptions& scene_options)
      : options(scene_options),
        centre{.focal_length_px =
                   static_cast<double>(std::max(scene_options.width_px, scene_options.height_px))},
        texture(scene_options.seed) {}

  [[nodiscard]] std::vector<SceneObject> objects_at(int frame) const {
    if (frame < 0) {
      throw UsageError(fmt::format("frame is {}, expected at least 0", frame));
    }
    return compose_scene(options, centre, frame);
  }
  LayeredSceneOptions options;
  CentreView centre;
  SceneTexture texture;
};

double LayeredSceneOptions::far_disparity_or_default() const {
  return far_disparity_px.value_or(width_px / 80.0);
}

double LayeredSceneOptions::near_disparity_or_default() const {
  return near_disparity_px.value_or(5 * far_disparity_or_default());
}

void LayeredSceneOptions::validate() const {
  require_between("width", width_px, 1, kMaxGeneratedSidePx);
  require_between("height", height_px, 1, kMaxGeneratedSidePx);
  require_between("far disparity", far_disparity_or_default(), 1e-3, kMaxGeneratedSidePx);
  require_between("near disparity", near_disparity_or_default(), 1.5 * far_disparity_or_default(),
                  5.0 * kMaxGeneratedSidePx);
  require_between("frames per cycle", frames_per_cycle, 1, 1e9);
  require_between("samples per side", samples_per_side, 1, 8);
  require_between("right gain", right_gain, 0.1, 10);
  require_between("right offset", right_offset, -255, 255);
  require_between("noise", noise_sigma, 0, 255);
}

LayeredScene::LayeredScene(const LayeredSceneOptions& options, Execution& execution)
    : options_(options), execution_(&execution) {
  options_.validate();
  content_ = std::make_unique<const Content>(options_);
}

LayeredScene::~LayeredScene() = default;
LayeredScene::LayeredScene(LayeredScene&&) noexcept = default;

double LayeredScene::focal_length_px() const { return content_->centre.focal_length_px; }

PosedCamera LayeredScene::camera(SceneView view) const {
  require_between("view x", view.x, -kMaxBaselines, kMaxBaselines);
  require_between("view y", view.y, -kMaxBaselines, kMaxBaselines);
  PosedCamera camera{.translation = Vector3d(-view.x, -view.y, 0),
                     .width_px = options_.width_px,
                     .height_px = options_.height_px};
  camera.matrix << focal_length_px(), 0, (options_.width_px - 1) / 2.0, 0, focal_length_px(),
      (options_.height_px - 1) / 2.0, 0, 0, 1;
  return camera;
}

SceneRendering LayeredScene::render(const PosedCamera& camera, int frame) const {
  camera.validate("camera of the scene");
  const std::vector<SceneObject> objects = content_->objects_at(frame);
  const Shot shot(objects, camera);
  const Vector3d position = shot.camera().position();
  const int samples = options_.samples_per_side;
  const double towards_right = std::clamp(position.x(), 0.0, 1.0);
  const double gain = 1 + towards_right * (options_.right_gain - 1);
  const double offset = towards_right * options_.right_offset;
  const std::uint64_t noise_seed =
      mix_bits(mix_bits(mix_bits(options_.seed + static_cast<std::uint64_t>(frame)) ^
                        std::bit_cast<std::uint64_t>(position.x())) ^
               std::bit_cast<std::uint64_t>(position.y()));

  const auto colour_at = [&](double x_px, double y_px) {
    const Ray ray = shot.camera().ray_through(x_px, y_px);
    const Hit hit = shot.first_hit(ray, x_px, y_px);
    if (hit.t == kNoHit) {
      return Vector3d(Vector3d::Zero());
    }
    const SceneObject& object = objects[static_cast<std::size_t>(hit.object)];
    const Vector3d colour =
        content_->texture.colour(object.palette, object.surface->detail(ray.at(hit.t)));
    // A sample is clipped like a sensor's, as are the pixels.
    return Vector3d(colour.cwiseMax(0.0).cwiseMin(255.0));
  };

  Image<std::uint8_t> image(camera.width_px, camera.height_px, 3);
  SceneRendering rendering{
      {}, DisparityMap(camera.width_px, camera.height_px), Mask(camera.width_px, camera.height_px)};
  execution_->for_each_row(camera.height_px, [&](int y) {
    PortableRandom noise(noise_seed, static_cast<std::uint64_t>(y));
    for (int x = 0; x < camera.width_px; ++x) {
      const Ray centre_ray = shot.camera().ray_through(x, y);
      const Hit centre_hit = shot.first_hit(centre_ray, x, y);
      rendering.disparity.at(x, y) = centre_hit.t == kNoHit
                                         ? std::numeric_limits<float>::quiet_NaN()
                                         : static_cast<float>(focal_length_px() / centre_hit.t);
      rendering.uniform.at(x, y) =
          centre_hit.t != kNoHit && objects[static_cast<std::size_t>(centre_hit.object)]
                                        .surface->detail(centre_ray.at(centre_hit.t))
                                        .is_uniform
              ? 255
              : 0;

      Vector3d sum = Vector3d::Zero();
      for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
          sum += colour_at(x + (i + 0.5) / samples - 0.5, y + (j + 0.5) / samples - 0.5);
        }
      }
      const Vector3d colour = gain / (samples * samples) * sum + Vector3d::Constant(offset);
      for (int c = 0; c < 3; ++c) {
        const double noisy = options_.noise_sigma > 0
                                 ? colour[c] + options_.noise_sigma * noise.normal()
                                 : colour[c];
        image.at(x, y, c) =
            static_cast<std::uint8_t>(std::clamp(std::floor(noisy + 0.5), 0.0, 255.0));
      }
    }
  });
  rendering.image.pixels = std::move(image);
  return rendering;
}

SceneRendering LayeredScene::render(SceneView view, int frame) const {
  return render(camera(view), frame);
}

Mask LayeredScene::occlusion(const PosedCamera& from, const PosedCamera& in, int frame) const {
  const std::vector<SceneObject> objects = content_->objects_at(frame);
  const Shot shot(objects, from);
  const Shot other(objects, in);
  Mask occluded(from.width_px, from.height_px);
  execution_->for_each_row(from.height_px, [&](int y) {
    for (int x = 0; x < from.width_px; ++x) {
      const Ray ray = shot.camera().ray_through(x, y);
      const Hit hit = shot.first_hit(ray, x, y);
      const bool is_visible = hit.t != kNoHit && other.sees(ray.at(hit.t));
      occluded.at(x, y) = is_visible ? 0 : 255;
    }
  });
  return occluded;
}

Mask LayeredScene::occlusion(SceneView from, SceneView in, int frame) const {
  return occlusion(camera(from), camera(in), frame);
}

ScenePoint LayeredScene::point_at(SceneView view, int frame, double x_px, double y_px) const {
  const std::vector<SceneObject> objects = content_->objects_at(frame);
  const Shot shot(objects, camera(view));
  const Ray ray = shot.camera().ray_through(x_px, y_px);
  const Hit hit = shot.first_hit(ray, x_px, y_px);
  const Vector3d point = ray.at(hit.t);
  return {point.x(), point.y(), point.z(), hit.object};
}

}  // namespace vantage
