#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <vector>

namespace vantage {

/// A ray: origin + t · direction, t > 0. The direction need not have unit length.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;

  [[nodiscard]] Eigen::Vector3d at(double t) const { return origin + t * direction; }
};

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

/// Bounding sphere of a surface; infinite radius for unbounded surfaces.
struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = std::numeric_limits<double>::infinity();
};

/// Properties of a surface point that determine its colour.
struct SurfaceDetail {
  Eigen::Vector3d normal;   ///< unit length, towards the lit side
  Eigen::Vector3d texture;  ///< moves with the surface; unit: about a pixel of the centre view
  double pattern = 0;       ///< 0..1, blends between two sets of colours
  double light = 1;         ///< fraction of the light that reaches the point, 0..1
  bool is_uniform = false;  ///< without texture and pattern
};

/// One opaque surface at one time, in world coordinates. Thread rule: immutable.
class Surface {
 public:
  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  virtual ~Surface() = default;

  /// The smallest t > 0 at which the ray meets the surface, or kNoHit.
  [[nodiscard]] virtual double intersect(const Ray& ray) const = 0;
  /// `point` lies on the surface.
  [[nodiscard]] virtual SurfaceDetail detail(const Eigen::Vector3d& point) const = 0;
  [[nodiscard]] virtual Ball bounds() const { return {}; }
};

/// The camera midway between left and right, in which the scene is laid out: maps between its image
/// (pixels from the principal point, and disparity) and the world.
struct CentreView {
  double focal_length_px = 1;

  [[nodiscard]] Eigen::Vector3d world(double u_px, double v_px, double disparity_px) const {
    return {0.5 + u_px / disparity_px, v_px / disparity_px, focal_length_px / disparity_px};
  }
  /// Texture coordinates of static surfaces: position of the point in the centre view.
  [[nodiscard]] Eigen::Vector3d image_position(const Eigen::Vector3d& point) const {
    const double scale = focal_length_px / point.z();
    return {(point.x() - 0.5) * scale, point.y() * scale, 0};
  }
};

/// A wall across the view whose depth is a wave along x plus one along y, with extremes far_z and
/// near_z. Nearest hits are found for rays within about 45° of the Z axis.
std::unique_ptr<Surface> make_wavy_wall(CentreView centre, double near_z, double far_z);

/// The plane whose disparity in the centre view is d0 + du · u_px + dv · v_px, tiled, with a soft
/// shadow straight below each of `shadows`.
std::unique_ptr<Surface> make_floor(CentreView centre, double d0, double du, double dv,
                                    double tile_size, std::vector<Ball> shadows);

/// `rotation` rotates the texture with the sphere. texture_scale: texture units per world unit.
std::unique_ptr<Surface> make_sphere(const Ball& ball, const Eigen::Matrix3d& rotation,
                                     double texture_scale, double stripes);

/// An infinite upright cylinder whose axis passes through `centre`.
std::unique_ptr<Surface> make_column(const Eigen::Vector3d& centre, double radius,
                                     double texture_scale);

enum class Outline { kRectangle, kStar, kFlower, kRing };

/// A flat card: the points centre + s · half_width · X + t · half_height · Y, X and Y the first
/// columns of `rotation`, with (s, t) inside the outline, which lies within [−1, 1]².
/// `texture_origin` gives equal cards different textures.
struct Card {
  Outline outline = Outline::kRectangle;
  Eigen::Vector3d centre;
  Eigen::Matrix3d rotation;
  double half_width = 1;
  double half_height = 1;
  double texture_scale = 1;
  double texture_origin = 0;
  double uniform_share = 0;  ///< of both sides, around the middle: no texture there; 1: nowhere
};
std::unique_ptr<Surface> make_card(const Card& card);

}  // namespace vantage
