#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// How a lens bends rays, in the terms of OpenCV.
enum class LensKind {
  kStandard,  ///< cv::projectPoints: radial, tangential, rational, thin prism, tilted sensor
  kFisheye    ///< cv::fisheye: the distance from the centre is a polynomial of the angle
};

/// A camera with a lens. A point (X, Y, Z) of its own frame (X right, Y down, Z forward) has the
/// ray (X/Z, Y/Z), which is distorted and then projected to the pixel `matrix` · ray.
struct Camera {
  /// K, pixel ← ray: rows (fx, skew, cx), (0, fy, cy), (0, 0, 1), in pixels. Principal points are
  /// positions as in EQUATIONS §0: pixel centres at integers.
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  /// Coefficients in OpenCV's order. Standard: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [τx τy]]]],
  /// 0 (none), 4, 5, 8, 12 or 14 of them. Fisheye: k1 k2 k3 k4, with which a ray at the angle θ
  /// from the axis is at θ · (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸) instead of tan θ.
  std::vector<double> distortion = {};
  LensKind lens = LensKind::kStandard;

  /// True for a standard lens whose coefficients are all 0.
  [[nodiscard]] bool is_without_distortion() const;
  /// Throws Error naming `name` ("left camera"), the quantity, its value and its limit.
  void validate(const std::string& name) const;
};

/// Projects rays to pixels, and back. Thread rule: may be used concurrently.
class LensModel {
 public:
  /// `camera` is valid.
  explicit LensModel(const Camera& camera);

  /// Pixel position of the point on `ray` (X/Z, Y/Z). None beyond the radius up to which the
  /// distortion is monotonic: farther out the polynomial folds back and the image would repeat,
  /// mirrored.
  [[nodiscard]] std::optional<Eigen::Vector2d> position_of(const Eigen::Vector2d& ray) const;

  /// The inverse, to 1e-10 of a focal length (damped Newton). None if no ray is found, as at
  /// positions that only the folded part of the polynomial reaches.
  [[nodiscard]] std::optional<Eigen::Vector2d> ray_of(const Eigen::Vector2d& position_px) const;

  /// |ray| up to which position_of() has a result; at most tan 80°.
  [[nodiscard]] double largest_ray() const { return largest_ray_; }

 private:
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ray) const;
  /// The ray that a fisheye lens brings to `distorted`, wherever that is.
  [[nodiscard]] Eigen::Vector2d fisheye_ray(const Eigen::Vector2d& distorted) const;

  Eigen::Matrix3d matrix_;
  Eigen::Matrix3d inverse_matrix_;
  std::array<double, 14> coefficients_;
  LensKind kind_;
  Eigen::Matrix3d tilt_;
  bool is_tilted_;
  double largest_ray_;
};

}  // namespace vantage
