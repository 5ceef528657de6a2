#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "kernels/candidates.h"

namespace vantage {

/// One image's intensities as matching costs read them: rows with margins, so that every lane of
/// every candidate can be loaded, and optionally mirrored, so that partners of increasing
/// disparities lie at increasing addresses. Pixel is uint8_t or float, or an unsigned integer type
/// of a feature.
template <typename Pixel>
class IntensityPlane {
 public:
  /// `margin_begin`, `margin_end`: columns before and after the image, filled with the border
  /// pixel.
  void resize(int width, int height, int margin_begin, int margin_end);
  /// Writes the margins of one row whose pixels are filled.
  void fill_margins(int y);
  /// The first pixel of row y (of a mirrored plane: the image's last column).
  [[nodiscard]] Pixel* row(int y) { return pixels_.row(y) + margin_begin_; }
  [[nodiscard]] const Pixel* row(int y) const { return pixels_.row(y) + margin_begin_; }
  [[nodiscard]] std::size_t held_bytes() const { return vantage::held_bytes(pixels_); }

 private:
  Image<Pixel> pixels_;
  int width_ = 0;
  int margin_begin_ = 0;
  int margin_end_ = 0;
};

/// Both images of a pair, ready for matching costs.
template <typename Pixel>
struct IntensityPlanes {
  IntensityPlane<Pixel> left;
  IntensityPlane<Pixel> right;
  IntensityPlane<Pixel> right_mirrored;

  [[nodiscard]] std::size_t held_bytes() const {
    return left.held_bytes() + right.held_bytes() + right_mirrored.held_bytes();
  }
};

/// Which map the planes are for.
struct PlanesNeeded {
  bool left_reference = true;
  bool right_reference = true;
};

/// Working memory of a pair: 8-bit grey pairs stay 8-bit and are matched in exact integers; all
/// others become float intensities (luma of colour, Rec. 601; EQUATIONS §0).
struct PreparedPair {
  bool is_8_bit = true;
  float cost_unit = 1;  ///< grey levels² per unit of squared difference of the float planes
  IntensityPlanes<std::uint8_t> grey_8;
  IntensityPlanes<float> grey_float;

  /// From two photographs of equal size. Float planes hold intensities times a power of two, the
  /// largest for which squared differences stay below kernels::kFloatSquareLimit and the sum of
  /// `window_samples` of them below 2³¹. Costs are then integers with the finest possible step, and
  /// their sums are exact. Identical for any `execution`.
  void prepare(const Photograph& left, const Photograph& right,
               const kernels::CandidateGeometry& geometry, int window_samples, PlanesNeeded needed,
               Execution& execution);
};

}  // namespace vantage
