#include "engine/synthesis/three_step_synthesizer.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>

#include "engine/image/remapped_row.h"
#include "engine/view_geometry/new_view.h"
#include "engine/view_geometry/trifocal_rectification.h"

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

PosedCamera camera_of(const RectifiedPair& pair, Side side) {
  PosedCamera camera{
      .matrix = pair.camera(side).matrix, .width_px = pair.width_px, .height_px = pair.height_px};
  if (side == Side::kRight) {
    camera.translation.x() = -pair.baseline;
  }
  return camera;
}

// Position in the source of pixel (x, y) of the result; NaN behind its camera.
Eigen::Vector2f source_position(const Eigen::Matrix3d& source_from_result, int x, int y) {
  const Eigen::Vector3d position = source_from_result * Eigen::Vector3d(x, y, 1);
  if (!(position.z() > 0)) {
    return {kUnknown, kUnknown};
  }
  return position.hnormalized().cast<float>();
}

template <typename T>
Image<T> moved_by(const Image<T>& source, const Eigen::Matrix3d& source_from_result, int width_px,
                  int height_px, Execution& execution) {
  Image<T> result(width_px, height_px, source.channels());
  execution.for_each_band(height_px, [&](int first_row, int end_row) {
    const auto floats = static_cast<std::size_t>(width_px);
    const auto memory = execution.scratch().lease(2 * floats * sizeof(float));
    auto* x_px = reinterpret_cast<float*>(memory.data());
    float* y_px = x_px + floats;
    for (int y = first_row; y < end_row; ++y) {
      for (int x = 0; x < width_px; ++x) {
        const Eigen::Vector2f position = source_position(source_from_result, x, y);
        x_px[x] = position.x();
        y_px[x] = position.y();
      }
      remap_row(source, x_px, y_px, y, result);
    }
  });
  return result;
}

Photograph moved_by(const Photograph& source, const Eigen::Matrix3d& source_from_result,
                    int width_px, int height_px, Execution& execution) {
  return std::visit(
      [&](const auto& image) {
        return Photograph{moved_by(image, source_from_result, width_px, height_px, execution)};
      },
      source.pixels);
}

// Calls body(x, y, source x, source y) for all pixels of the result whose nearest source pixel
// exists.
template <typename Body>
void for_each_source_pixel(const Eigen::Matrix3d& source_from_result, int width_px, int height_px,
                           int source_width, int source_height, Execution& execution,
                           const Body& body) {
  execution.for_each_row(height_px, [&](int y) {
    for (int x = 0; x < width_px; ++x) {
      const Eigen::Vector2f position = source_position(source_from_result, x, y);
      const float column = std::floor(position.x() + 0.5F);
      const float line = std::floor(position.y() + 0.5F);
      if (column >= 0 && column < static_cast<float>(source_width) && line >= 0 &&
          line < static_cast<float>(source_height)) {
        body(x, y, static_cast<int>(column), static_cast<int>(line));
      }
    }
  });
}

// Disparities are taken from the nearest pixel, because they must not be interpolated between
// surfaces. A pixel (x, y) of depth Z has depth Z w in the common frame, where w is the third
// component of its homography; the focal length and the unit differ, too.
DisparityMap rectified_map(ImageView<const float> map_px, const RectifiedPair& pair,
                           const TrifocalRectification& rig, const Eigen::Matrix3d& homography,
                           Execution& execution) {
  DisparityMap result(rig.width_px, rig.height_px);
  result.fill(kUnknown);
  const double scale = rig.focal_length_px / pair.left.matrix(0, 0);
  for_each_source_pixel(
      homography.inverse(), rig.width_px, rig.height_px, map_px.width(), map_px.height(), execution,
      [&](int x, int y, int from_x, int from_y) {
        const double depth_ratio = homography.row(2).dot(Eigen::Vector3d(from_x, from_y, 1));
        result.at(x, y) =
            static_cast<float>(scale * (map_px.at(from_x, from_y) + pair.doffs_px) / depth_ratio);
      });
  return result;
}

// Warps a mask by nearest pixels; `outside` where there is none.
Mask moved_mask(const Mask& source, std::uint8_t outside, const Eigen::Matrix3d& source_from_result,
                const PosedCamera& camera, Execution& execution) {
  Mask result(camera.width_px, camera.height_px);
  result.fill(outside);
  for_each_source_pixel(source_from_result, camera.width_px, camera.height_px, source.width(),
                        source.height(), execution, [&](int x, int y, int from_x, int from_y) {
                          result.at(x, y) = source.at(from_x, from_y);
                        });
  return result;
}

double share_set(const Mask& mask) {
  std::int64_t set = 0;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      set += mask.at(x, y) != 0 ? 1 : 0;
    }
  }
  return static_cast<double>(set) / (static_cast<double>(mask.width()) * mask.height());
}

TrifocalRectification rectification_of(const RectifiedPair& pair, const PosedCamera& camera) {
  return trifocal_rectification(camera_of(pair, Side::kLeft), camera_of(pair, Side::kRight),
                                camera);
}

}  // namespace

ThreeStepSynthesizer::ThreeStepSynthesizer(const SynthesisOptions& options, Execution& execution)
    : synthesizer_(options, execution), execution_(execution) {}

void ThreeStepSynthesizer::synthesize(const ViewSource& source, const RectifiedPair& pair,
                                      const PosedCamera& camera, SynthesizedView& view,
                                      const std::array<IntensityFit, 4>* given_fit) const {
  const TrifocalRectification rig = rectification_of(pair, camera);
  const auto rectified = [&](const Photograph& image, std::size_t number) {
    return moved_by(image, rig.homographies[number].inverse(), rig.width_px, rig.height_px,
                    execution_);
  };
  SynthesizedView in_plane;
  synthesizer_.synthesize(
      {rectified(source.left, 0), rectified(source.right, 1),
       rectified_map(source.left_disparity_px, pair, rig, rig.homographies[0], execution_).view(),
       rectified_map(source.right_disparity_px, pair, rig, rig.homographies[1], execution_).view()},
      baseline_view(rig.view_x, rig.view_y, rig.width_px, rig.height_px), in_plane, given_fit);
  const Eigen::Matrix3d& derectifying = rig.homographies[2];
  view.image =
      moved_by(in_plane.image, derectifying, camera.width_px, camera.height_px, execution_);
  view.holes = moved_mask(in_plane.holes, 255, derectifying, camera, execution_);
  view.sources = moved_mask(in_plane.sources, 0, derectifying, camera, execution_);
  view.intensity = in_plane.intensity;
  view.hole_fraction = share_set(view.holes);
}

std::size_t ThreeStepSynthesizer::working_bytes(const SynthesisOptions& options,
                                                const RectifiedPair& pair,
                                                const PosedCamera& camera, int channels,
                                                int bytes_per_value) {
  const TrifocalRectification rig = rectification_of(pair, camera);
  const auto pixels =
      static_cast<std::size_t>(rig.width_px) * static_cast<std::size_t>(rig.height_px);
  const std::size_t photograph =
      pixels * static_cast<std::size_t>(channels) * static_cast<std::size_t>(bytes_per_value);
  // Both images and the view between them; both maps; two masks.
  return 3 * photograph + pixels * (2 * sizeof(float) + 2) +
         ViewSynthesizer::filling_bytes(options, rig.width_px, rig.height_px, channels) +
         ViewSynthesizer::working_bytes(
             baseline_view(rig.view_x, rig.view_y, rig.width_px, rig.height_px), rig.width_px,
             rig.height_px, channels);
}

}  // namespace vantage
