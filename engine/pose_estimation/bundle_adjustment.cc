#include "engine/pose_estimation/bundle_adjustment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr int kOfCamera = 6;
constexpr int kOfLens = 2;
constexpr double kMinBundleDepth = 1e-9;
// How far the lens is expected to be from its start: weak, for bundles that do not tell it.
constexpr double kSpreadOfLogFocal = 0.5;
constexpr double kSpreadOfK1 = 0.3;

using CameraBlock = Eigen::Matrix<double, 2, kOfCamera>;
using LensBlock = Eigen::Matrix<double, 2, kOfLens>;
using PointBlock = Eigen::Matrix<double, 2, 3>;

/// Error of a sighting and its derivatives by a turn and a shift of the camera, by log focal_px and
/// k1, and by the point.
struct LinearSighting {
  Eigen::Vector2d error;
  CameraBlock camera;
  LensBlock lens;
  PointBlock point;
};

Eigen::Vector2d project(const BundleLens& lens, const Eigen::Vector3d& at) {
  const Eigen::Vector2d ray = at.head<2>() / at.z();
  return lens.focal_px * (1 + lens.k1 * ray.squaredNorm()) * ray;
}

std::optional<LinearSighting> linear(const Bundle& bundle, const PointSighting& sighting,
                                     const Eigen::Vector3d& point) {
  const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(sighting.image)];
  const Eigen::Vector3d at = camera.rotation * (point - camera.centre);
  if (!(at.z() > kMinBundleDepth)) {
    return std::nullopt;
  }
  const Eigen::Vector2d ray = at.head<2>() / at.z();
  const double square = ray.squaredNorm();
  const auto [focal_px, k1] = bundle.lens;
  PointBlock ray_by_at;
  ray_by_at << 1, 0, -ray.x(), 0, 1, -ray.y();
  ray_by_at /= at.z();
  const Eigen::Matrix2d by_ray =
      focal_px * ((1 + k1 * square) * Eigen::Matrix2d::Identity() + 2 * k1 * ray * ray.transpose());
  const PointBlock by_at = by_ray * ray_by_at;
  LinearSighting result;
  result.error = project(bundle.lens, at) - sighting.position_px;
  result.camera << -by_at * cross_matrix(at), -by_at * camera.rotation;
  result.lens << focal_px * (1 + k1 * square) * ray, focal_px * square * ray;
  result.point = by_at * camera.rotation;
  return result;
}

/// Of a start, to which a weak prior draws.
struct LensPrior {
  BundleLens start;
  double strength = 0;  ///< 0 where the lens is fixed

  [[nodiscard]] Eigen::Vector2d pull(const BundleLens& lens) const {
    return strength * Eigen::Vector2d(std::log(lens.focal_px / start.focal_px) /
                                          (kSpreadOfLogFocal * kSpreadOfLogFocal),
                                      (lens.k1 - start.k1) / (kSpreadOfK1 * kSpreadOfK1));
  }
  [[nodiscard]] double cost(const BundleLens& lens) const {
    return strength * (std::pow(std::log(lens.focal_px / start.focal_px) / kSpreadOfLogFocal, 2) +
                       std::pow((lens.k1 - start.k1) / kSpreadOfK1, 2));
  }
};

double robust_cost(const Bundle& bundle, double outlier_px) {
  const double square = outlier_px * outlier_px;
  double cost = 0;
  for (const PointTrack& track : bundle.tracks) {
    for (const PointSighting& sighting : track.sightings) {
      const Eigen::Vector2d seen = bundle.projection_px(sighting.image, track.point);
      // A point that is not ahead costs as much as one far away.
      const double error = std::min((seen - sighting.position_px).norm(), 1e4);
      cost += square * std::log1p(error * error / square);
    }
  }
  return cost;
}

/// The normal equations without the points, and what gives these back.
class ReducedSystem {
 public:
  ReducedSystem(const Bundle& bundle, double outlier_px, const LensPrior& prior)
      : bundle_(bundle),
        lens_at_(static_cast<Eigen::Index>(kOfCamera * bundle.cameras.size())),
        normal_(Eigen::MatrixXd::Zero(lens_at_ + kOfLens, lens_at_ + kOfLens)),
        right_side_(Eigen::VectorXd::Zero(lens_at_ + kOfLens)) {
    for (const PointTrack& track : bundle.tracks) {
      add(track, outlier_px * outlier_px);
    }
    normal_.diagonal().tail<kOfLens>() +=
        prior.strength * Eigen::Vector2d(1 / (kSpreadOfLogFocal * kSpreadOfLogFocal),
                                         1 / (kSpreadOfK1 * kSpreadOfK1));
    right_side_.tail<kOfLens>() -= prior.pull(bundle.lens);
  }

  /// The bundle moved by a damped step.
  [[nodiscard]] Bundle moved(double damping, bool fits_lens) const {
    Eigen::MatrixXd reduced = normal_;
    Eigen::VectorXd right_side = right_side_;
    const auto damp = [&](auto&& diagonal) {
      diagonal.array() = diagonal.array() * (1 + damping) + 1e-9;
    };
    damp(reduced.diagonal());
    std::vector<Eigen::Matrix3d> inverses;
    for (const Track& track : tracks_) {
      Eigen::Matrix3d own = track.normal;
      damp(own.diagonal());
      inverses.push_back(own.inverse());
      for (const Coupling& first : track.couplings) {
        const Eigen::MatrixXd folded = first.block * inverses.back();
        right_side.segment(first.at, first.block.rows()) -= folded * track.right_side;
        for (const Coupling& second : track.couplings) {
          reduced.block(first.at, second.at, first.block.rows(), second.block.rows()) -=
              folded * second.block.transpose();
        }
      }
    }
    const Eigen::Index size = fits_lens ? reduced.rows() : lens_at_;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(reduced.rows());
    change.head(size) = reduced.topLeftCorner(size, size).ldlt().solve(right_side.head(size));
    Bundle result = bundle_;
    for (std::size_t i = 0; i < result.cameras.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(kOfCamera * i);
      BundleCamera& camera = result.cameras[i];
      camera.rotation = rotation_by(change.segment<3>(at)) * camera.rotation;
      camera.centre += change.segment<3>(at + 3);
    }
    result.lens.focal_px *= std::exp(std::clamp(change[lens_at_], -0.5, 0.5));
    result.lens.k1 += change[lens_at_ + 1];
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      Eigen::Vector3d right_of_point = tracks_[i].right_side;
      for (const Coupling& coupling : tracks_[i].couplings) {
        right_of_point -=
            coupling.block.transpose() * change.segment(coupling.at, coupling.block.rows());
      }
      result.tracks[i].point += inverses[i] * right_of_point;
    }
    return result;
  }

 private:
  /// The part of the normal equations between parameters from `at` on and a point.
  struct Coupling {
    Eigen::Index at = 0;
    Eigen::Matrix<double, Eigen::Dynamic, 3> block;
  };
  struct Track {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
    std::vector<Coupling> couplings;
  };

  void add(const PointTrack& track, double outlier_square) {
    Track sums;
    Eigen::Matrix<double, kOfLens, 3> of_lens = Eigen::Matrix<double, kOfLens, 3>::Zero();
    for (const PointSighting& sighting : track.sightings) {
      const auto here = linear(bundle_, sighting, track.point);
      if (!here) {
        continue;
      }
      const double weight = 1 / (1 + here->error.squaredNorm() / outlier_square);
      const auto at = static_cast<Eigen::Index>(kOfCamera * sighting.image);
      normal_.block<kOfCamera, kOfCamera>(at, at) +=
          weight * here->camera.transpose() * here->camera;
      normal_.block<kOfCamera, kOfLens>(at, lens_at_) +=
          weight * here->camera.transpose() * here->lens;
      normal_.block<kOfLens, kOfCamera>(lens_at_, at) +=
          weight * here->lens.transpose() * here->camera;
      normal_.block<kOfLens, kOfLens>(lens_at_, lens_at_) +=
          weight * here->lens.transpose() * here->lens;
      right_side_.segment<kOfCamera>(at) -= weight * here->camera.transpose() * here->error;
      right_side_.segment<kOfLens>(lens_at_) -= weight * here->lens.transpose() * here->error;
      sums.normal += weight * here->point.transpose() * here->point;
      sums.right_side -= weight * here->point.transpose() * here->error;
      sums.couplings.push_back({at, weight * here->camera.transpose() * here->point});
      of_lens += weight * here->lens.transpose() * here->point;
    }
    sums.couplings.push_back({lens_at_, of_lens});
    tracks_.push_back(std::move(sums));
  }

  const Bundle& bundle_;
  Eigen::Index lens_at_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_side_;
  std::vector<Track> tracks_;
};

}  // namespace

Eigen::Vector2d Bundle::projection_px(int image, const Eigen::Vector3d& point) const {
  const BundleCamera& camera = cameras[static_cast<std::size_t>(image)];
  const Eigen::Vector3d at = camera.rotation * (point - camera.centre);
  return at.z() > kMinBundleDepth
             ? project(lens, at)
             : Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
}

std::vector<double> Bundle::errors_px() const {
  std::vector<double> errors;
  for (const PointTrack& track : tracks) {
    for (const PointSighting& sighting : track.sightings) {
      errors.push_back((projection_px(sighting.image, track.point) - sighting.position_px).norm());
    }
  }
  return errors;
}

double rms_of(const std::vector<double>& errors_px) {
  double sum = 0;
  int count = 0;
  for (const double error : errors_px) {
    if (std::isfinite(error)) {
      sum += error * error;
      ++count;
    }
  }
  return std::sqrt(sum / std::max(count, 1));
}

void adjust_bundle(Bundle& bundle, double outlier_px, bool fits_lens) {
  constexpr int kSteps = 60;
  constexpr double kConverged = 1e-7;
  const LensPrior prior{.start = bundle.lens, .strength = fits_lens ? 1.0 : 0.0};
  const auto cost_of = [&](const Bundle& at) {
    return robust_cost(at, outlier_px) + prior.cost(at.lens);
  };
  double damping = 1e-4;
  double cost = cost_of(bundle);
  for (int step = 0; step < kSteps && damping < 1e8; ++step) {
    const ReducedSystem system(bundle, outlier_px, prior);
    double next_cost = cost;
    for (; damping < 1e8; damping *= 8) {
      Bundle next = system.moved(damping, fits_lens);
      next_cost = cost_of(next);
      if (next_cost < cost) {
        bundle = std::move(next);
        damping = std::max(damping / 8, 1e-9);
        break;
      }
    }
    if (!(next_cost < cost * (1 - kConverged))) {
      break;
    }
    cost = next_cost;
  }
}

}  // namespace vantage
