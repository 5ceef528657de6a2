#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "engine/matching/costs/intensity_planes.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/census/census.h"

namespace vantage {

/// One quantity of every pixel, and the same with mirrored rows where the image is the partner of a
/// left reference.
template <typename T>
struct FeaturePlane {
  IntensityPlane<T> plain;
  IntensityPlane<T> mirrored;

  /// Writes the margins of plain row y, whose pixels are in place, and, if wanted, the mirrored
  /// row.
  void finish_row(int width, int y, bool mirror) {
    plain.fill_margins(y);
    if (mirror) {
      std::reverse_copy(plain.row(y), plain.row(y) + width, mirrored.row(y));
      mirrored.fill_margins(y);
    }
  }
};

/// What the costs of one image's channels look up. `features[channel]` holds
///   squared, absolute, truncated, contaminated:  grey levels
///   Birchfield–Tomasi:  grey levels, their least and largest values within half a pixel
///   gradient:           α·gx, α·gy, |g|/2
/// `codes[channel]` the two halves of census codes, `ray_codes` the bytes of ray census
/// codes.
/// Combined: `fixed_levels[channel]` holds 16-bit grey levels and their bounds, `codes[0]` the
/// luma's codes, `fixed_gradients` its gradient.
struct CostImage::Planes {
  int width = 0;
  int height = 0;
  int channels = 1;  ///< 1 or 3
  bool has_mirrored = false;
  LevelChanges level_changes;
  std::array<std::array<FeaturePlane<float>, 3>, 3> features;
  std::array<std::array<FeaturePlane<std::uint32_t>, 2>, 3> codes;
  std::array<std::array<FeaturePlane<std::uint8_t>, kernels::kMostRayCensusBytes>, 3> ray_codes;
  std::array<std::array<FeaturePlane<std::uint16_t>, 3>, 3> fixed_levels;
  std::array<FeaturePlane<std::uint16_t>, 2> fixed_gradients;
  /// What features are made of where they are not the grey levels themselves.
  std::array<IntensityPlane<float>, 3> levels;
  std::array<IntensityPlane<float>, 3> smooth_levels;
  IntensityPlane<float> luma;  ///< combined cost of colour channels: what codes are made of
};

}  // namespace vantage
