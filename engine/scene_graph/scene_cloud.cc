#include "engine/scene_graph/scene_cloud.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/rectification/rectifier.h"
#include "engine/refinement/refinement.h"
#include "engine/scene_graph/cloud_geometry.h"
#include "engine/scene_graph/fused_map.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/scene_graph/scene_camera.h"

namespace vantage {
namespace {

constexpr float kUnknownDisparity = std::numeric_limits<float>::quiet_NaN();

/// An image of the scene, undistorted.
struct CloudImage {
  Image<std::uint8_t> colours;
  DisparityMap disparity_px;  ///< scale / depth of matched pixels away from jumps, else NaN
  Mask kept;                  ///< 255 where enough images agree; set when its points are made
};

/// Disparities become unknown where `mask` is not 0.
void forget_where(const Mask& mask, DisparityMap& disparity_px, Execution& execution) {
  fill_unmatched(mask, Side::kLeft, Fill::kNone, execution, disparity_px);
}

struct Neighbour {
  const CloudImage* image = nullptr;
  bool is_made = false;  ///< its points are made
  ViewWarp to;
  ViewWarp back;
};

/// A pixel of a neighbour that shows the same point.
struct SamePoint {
  /// As the own image has it; none at the border, where it is not known as exactly.
  std::optional<double> disparity_px;
  bool is_made = false;  ///< a point of an image before
};

std::optional<SamePoint> same_point(const Neighbour& neighbour, double x, double y, double d,
                                    double tolerance_px) {
  const DisparityMap& map = neighbour.image->disparity_px;
  const Eigen::Vector3d at = projected(neighbour.to, x, y, d);
  const double column = std::round(at.x());
  const double row = std::round(at.y());
  if (!(at.z() > 0 && column >= 0 && column < map.width() && row >= 0 && row < map.height())) {
    return std::nullopt;
  }
  const double u = std::clamp(at.x(), 0.0, map.width() - 1.0);
  const double v = std::clamp(at.y(), 0.0, map.height() - 1.0);
  const auto found = static_cast<double>(interpolated_disparity(map.view(), u, v));
  if (!(std::abs(found - d / at.z()) <= tolerance_px)) {
    return std::nullopt;
  }
  SamePoint same;
  if (u == at.x() && v == at.y()) {
    same.disparity_px = found / projected(neighbour.back, u, v, found).z();
  }
  same.is_made = neighbour.is_made &&
                 neighbour.image->kept.at(static_cast<int>(column), static_cast<int>(row)) != 0;
  return same;
}

}  // namespace

struct SceneCloudMaker::Content {
  Content(const StoredScene& scene, LoadVertex load_vertex, const SceneCloudOptions& options,
          Execution& execution)
      : cameras_(scene.cameras()),
        width_px_(scene.width_px),
        height_px_(scene.height_px),
        unit_length_(scene.unit_length),
        scale_px_(scene.focal_length_px * scene.unit_length),
        neighbours_(cameras_.size()),
        is_made_(cameras_.size(), false),
        load_vertex_(std::move(load_vertex)),
        options_(options),
        execution_(execution) {
    for (const StoredEdge& edge : scene.edges) {
      neighbours_[static_cast<std::size_t>(edge.edge.first)].push_back(edge.edge.second);
      neighbours_[static_cast<std::size_t>(edge.edge.second)].push_back(edge.edge.first);
    }
  }

  /// Of the images that are left, that with the most neighbours before it: what it shows is then
  /// rarely duplicated. -1: none is left.
  [[nodiscard]] int next() const {
    int best = -1;
    std::ptrdiff_t max_made = -1;
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const auto made = std::ranges::count_if(
          neighbours_[i], [&](int other) { return is_made_[static_cast<std::size_t>(other)]; });
      if (!is_made_[i] && made > max_made) {
        max_made = made;
        best = static_cast<int>(i);
      }
    }
    return best;
  }

  void add_image(int number) {
    CloudImage& image = loaded(number);
    std::vector<Neighbour> neighbours;
    for (const int other : neighbours_[static_cast<std::size_t>(number)]) {
      neighbours.push_back({.image = &loaded(other),
                            .is_made = is_made_[static_cast<std::size_t>(other)],
                            .to = warp(number, other),
                            .back = warp(other, number)});
    }
    Image<float> depths(width_px_, height_px_);  // of the points, NaN where there is none
    image.kept.resize(width_px_, height_px_);
    execution_.for_each_row(height_px_, [&](int y) { decide_row(y, neighbours, image, depths); });
    append(number, image, depths);
    is_made_[static_cast<std::size_t>(number)] = true;
    release();
  }

  CloudImage& loaded(int number) {
    const auto [found, is_new] = loaded_.try_emplace(number);
    CloudImage& image = found->second;
    if (is_new) {
      SceneVertex stored = load_vertex_(number);
      const Camera& lens = cameras_[static_cast<std::size_t>(number)].lens;
      image.colours = eight_bit(undistorted(std::move(stored.image), lens, execution_));
      fuse_matches(stored, image.disparity_px);
    }
    return image;
  }

  /// Of matched pixels only: what is filled is a guess.
  void fuse_matches(SceneVertex& stored, DisparityMap& disparity_px) const {
    for (SceneEdgeMap& map : stored.maps) {
      forget_where(map.unmatched, map.disparity_px, execution_);
    }
    disparity_px.resize(width_px_, height_px_);
    fuse_maps(maps_of(stored), unit_length_, options_.tolerance_px, disparity_px.view(),
              execution_);
    Mask outlines;
    outline_mask(disparity_px.view(), static_cast<double>(kSurfaceLimit_px), execution_, outlines);
    forget_where(outlines, disparity_px, execution_);
  }

  [[nodiscard]] ViewWarp warp(int from, int to) const {
    const SceneCamera& target = cameras_[static_cast<std::size_t>(to)];
    return warp_between(cameras_[static_cast<std::size_t>(from)], target.lens.matrix, target.pose,
                        scale_px_);
  }

  void decide_row(int y, const std::vector<Neighbour>& neighbours, CloudImage& image,
                  Image<float>& depths) const {
    for (int x = 0; x < width_px_; ++x) {
      depths.at(x, y) = kUnknownDisparity;
      image.kept.at(x, y) = 0;
      const auto d = static_cast<double>(image.disparity_px.at(x, y));
      if (!(d > 0)) {
        continue;
      }
      int images = 1;
      int averaged = 1;
      double sum_px = d;
      bool is_made = false;
      for (const Neighbour& neighbour : neighbours) {
        if (const auto same = same_point(neighbour, x, y, d, options_.tolerance_px)) {
          ++images;
          averaged += same->disparity_px ? 1 : 0;
          sum_px += same->disparity_px.value_or(0);
          is_made = is_made || same->is_made;
        }
      }
      const double depth = scale_px_ * averaged / sum_px;
      if (images < options_.min_images || depth > options_.max_depth.value_or(kNoMaxDepth)) {
        continue;
      }
      image.kept.at(x, y) = 255;
      if (!is_made && x % options_.step_px == 0 && y % options_.step_px == 0) {
        depths.at(x, y) = static_cast<float>(depth);
      }
    }
  }

  void append(int number, const CloudImage& image, const Image<float>& depths) {
    const SceneCamera& camera = cameras_[static_cast<std::size_t>(number)];
    const Eigen::Matrix3d ray_of = camera.lens.matrix.inverse();
    const Eigen::Matrix3d to_world = camera.pose.rotation.transpose();
    const Eigen::Vector3d centre = camera.pose.centre();
    const bool is_grey = image.colours.channels() == 1;
    for (int y = 0; y < height_px_; y += options_.step_px) {
      for (int x = 0; x < width_px_; x += options_.step_px) {
        const auto depth = static_cast<double>(depths.at(x, y));
        if (std::isnan(depth)) {
          continue;
        }
        const Eigen::Vector3d point =
            to_world * (ray_of * Eigen::Vector3d(x, y, 1)) * depth + centre;
        // Points of the plane d = (a, b, c') · (x, y, 1) have d Z = scale, hence
        // (a, b, c') · K · X = scale.
        Eigen::Vector3d plane = plane_around(image.disparity_px, x, y);
        plane.z() -= plane.x() * x + plane.y() * y;
        const Eigen::Vector3d normal =
            -(to_world * (camera.lens.matrix.transpose() * plane)).normalized();
        for (int axis = 0; axis < 3; ++axis) {
          cloud_.positions.push_back(static_cast<float>(point[axis]));
          cloud_.normals.push_back(static_cast<float>(normal[axis]));
          cloud_.colours.push_back(image.colours.at(x, y, is_grey ? 0 : axis));
        }
      }
    }
  }

  /// Images whose neighbours are all done.
  void release() {
    const auto is_made = [&](int number) { return is_made_[static_cast<std::size_t>(number)]; };
    std::erase_if(loaded_, [&](const auto& entry) {
      return is_made(entry.first) &&
             std::ranges::all_of(neighbours_[static_cast<std::size_t>(entry.first)], is_made);
    });
  }

  std::vector<SceneCamera> cameras_;
  int width_px_;
  int height_px_;
  double unit_length_;
  double scale_px_;
  std::vector<std::vector<int>> neighbours_;  // of each image
  std::vector<bool> is_made_;
  LoadVertex load_vertex_;
  SceneCloudOptions options_;
  Execution& execution_;
  std::map<int, CloudImage> loaded_;
  PointCloud cloud_;
};

void SceneCloudOptions::validate() const {
  if (min_images < 1 || min_images > kMaxNeighbours) {
    throw UsageError(fmt::format("min-images is {}, expected a number from 1 to {}", min_images,
                                 kMaxNeighbours));
  }
  if (!(tolerance_px > 0 && std::isfinite(tolerance_px))) {
    throw UsageError(fmt::format("depth-tolerance is {}, expected a number above 0", tolerance_px));
  }
  if (max_depth && !(*max_depth > 0)) {
    throw UsageError(fmt::format("max-depth is {}, expected a number above 0", *max_depth));
  }
  if (step_px < 1 || step_px > kMaxCloudStep_px) {
    throw UsageError(
        fmt::format("cloud-step is {}, expected a number from 1 to {}", step_px, kMaxCloudStep_px));
  }
}

SceneCloudMaker::SceneCloudMaker(const StoredScene& scene, LoadVertex load_vertex,
                                 const SceneCloudOptions& options, Execution& execution) {
  options.validate();
  if (!scene.is_posed()) {
    throw UsageError("the scene has no poses, expected one made with `poses`");
  }
  content_ = std::make_unique<Content>(scene, std::move(load_vertex), options, execution);
}

SceneCloudMaker::~SceneCloudMaker() = default;

bool SceneCloudMaker::add_image() {
  const int number = content_->next();
  if (number < 0) {
    return false;
  }
  content_->add_image(number);
  return true;
}

PointCloud SceneCloudMaker::finish() {
  if (content_->cloud_.size() == 0) {
    throw Error(fmt::format(
        "no point is seen at one depth in {} images, expected some: lower min-images, or raise "
        "max-depth or depth-tolerance",
        content_->options_.min_images));
  }
  return std::move(content_->cloud_);
}

}  // namespace vantage
