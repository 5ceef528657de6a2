#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"
#include "engine/rectification/camera.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Position in the photograph of each pixel of a rectified image; NaN where the camera does not see
/// it. Nothing is owned.
struct PhotographPositions {
  ImageView<const float> x_px;
  ImageView<const float> y_px;
};

/// Rectifies photographs of a calibrated pair of cameras at the same size: rows correspond, and
/// lens distortion is removed. By default without pixels that the photographs do not show (see
/// RectificationOptions). The position map is computed once. Thread rule: after construction
/// everything may be called concurrently.
class Rectifier {
 public:
  /// For images of this size. Throws as rectified_pair() does. Takes 8 bytes per pixel and image,
  /// about 0.1 µs per pixel.
  Rectifier(const StereoCalibration& calibration, int width_px, int height_px,
            const RectificationOptions& options = {});

  /// False for calibrations of rectified images; apply() then merely copies.
  [[nodiscard]] bool needs_rectification() const { return needs_rectification_; }
  /// Cameras, baseline, homographies and the valid part of the rectified images.
  [[nodiscard]] const RectifiedPair& pair() const { return pair_; }

  /// Converts a position of the rectified image to the photograph, and back; both may be sub-pixel
  /// or outside. None if the camera cannot see it.
  [[nodiscard]] std::optional<Eigen::Vector2d> source_position(
      Side side, const Eigen::Vector2d& rectified_px) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> rectified_position(
      Side side, const Eigen::Vector2d& source_px) const;
  /// source_position() of all pixels, valid as long as the rectifier; empty unless
  /// needs_rectification().
  [[nodiscard]] PhotographPositions source_positions(Side side) const {
    return {view(side).x_px.view(), view(side).y_px.view()};
  }

  /// The rectified image of `source`, by bicubic interpolation (Keys, a = −½) at exact positions;
  /// alpha like a colour. Pixels that the camera did not see, or that are left out of the
  /// photograph, are left out of `result` (image/left_out.h). `result` gets the depth
  /// and channels of `source` and reuses its memory, so nothing is allocated from the second frame
  /// on; it must not be `source`. Parallel over rows; bit-identical for every executor and
  /// instruction set. Throws Error if `source` has another size than the photographs.
  void apply(const Photograph& source, Side side, Photograph& result, Execution& execution) const;

 private:
  struct View {
    LensModel lens;
    Eigen::Matrix3d ray_from_pixel;  ///< ray of the camera ← rectified pixel, homogeneous
    Image<float> x_px;               ///< position of each rectified pixel; NaN = not seen
    Image<float> y_px;
  };
  [[nodiscard]] Mask left_out_of(const Photograph& source, Side side, Execution& execution) const;
  [[nodiscard]] View make_view(const Camera& camera, Side side) const;
  [[nodiscard]] static std::optional<Eigen::Vector2d> source_position(
      const View& view, const Eigen::Vector2d& rectified_px);
  [[nodiscard]] const View& view(Side side) const { return views_[index_of(side)]; }

  ImageSize photograph_size_;
  RectifiedPair pair_;
  bool needs_rectification_;
  std::array<View, 2> views_;
};

/// The photograph of the pinhole camera with the same K and size: `source` itself without
/// distortion, black where the photograph shows nothing. Identical for any `execution`.
Photograph undistorted(Photograph source, const Camera& lens, Execution& execution);

/// The rectified positions of a photograph's pixels, for pixels in the order of rows. Lenses are
/// smooth: positions are interpolated between the corners of small patches, unless the lens bends
/// even those. Thread rule: one thread.
class RectifiedPositions {
 public:
  /// `rectifier` must outlive it.
  RectifiedPositions(const Rectifier& rectifier, Side side);

  /// NaN where the lens model has no position.
  [[nodiscard]] Eigen::Vector2d position(int x, int y) {
    if (y / kPatchPx != row_) {
      row_ = y / kPatchPx;
      make_patches();
    }
    const Patch& patch = patches_[static_cast<std::size_t>(x / kPatchPx)];
    return patch.is_smooth ? patch.position(static_cast<double>(x % kPatchPx) / kPatchPx,
                                            static_cast<double>(y % kPatchPx) / kPatchPx)
                           : exact(x, y);
  }

 private:
  static constexpr int kPatchPx = 8;

  struct Patch {
    bool is_smooth;
    std::array<Eigen::Vector2d, 4> corners;  // upper left and right, lower left and right

    [[nodiscard]] Eigen::Vector2d position(double along, double down) const {
      return (1 - down) * ((1 - along) * corners[0] + along * corners[1]) +
             down * ((1 - along) * corners[2] + along * corners[3]);
    }
  };

  [[nodiscard]] Eigen::Vector2d exact(double x, double y) const;
  void make_patches();

  const Rectifier& rectifier_;
  Side side_;
  std::vector<Patch> patches_;
  int row_ = -1;
};

}  // namespace vantage
