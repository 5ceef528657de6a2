#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/image/side.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

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
