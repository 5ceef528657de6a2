#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/matching/costs/cost_planes.h"
#include "kernels/census/census.h"

namespace vantage {

/// The two halves of census codes.
using CensusCodes = PlaneSet<std::uint32_t, 2>;

inline void resize_codes(const PlaneSource& source, CensusCodes& codes) {
  for (FeaturePlane<std::uint32_t>& half : codes) {
    half.resize(source);
  }
}

/// Computes row y of the codes of `intensities`, which must have filter margins.
inline void census_code_row(const PlaneSource& source, const IntensityPlane<float>& intensities,
                            int y, CensusCodes& codes) {
  kernels::CensusRows rows{};
  for (int v = -kernels::kCensusRadiusY; v <= kernels::kCensusRadiusY; ++v) {
    rows[static_cast<std::size_t>(v + kernels::kCensusRadiusY)] =
        intensities.row(std::clamp(y + v, 0, source.height() - 1));
  }
  auto& [first_half, second_half] = codes;
  kernels::census_code_row(rows, source.width(), first_half.plain.row(y), second_half.plain.row(y));
  first_half.finish_row(source, y);
  second_half.finish_row(source, y);
}

}  // namespace vantage
