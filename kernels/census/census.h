#pragma once

#include <array>
#include <cstdint>

#include "kernels/feature_pairs.h"

namespace vantage::kernels {

/// The window of census codes.
inline constexpr int kCensusRadiusX = 4;
inline constexpr int kCensusRadiusY = 3;

/// Rows y − 3 … y + 3 of an image.
using CensusRows = std::array<const float*, 2 * kCensusRadiusY + 1>;

/// Census codes of `width` pixels: which of the 62 neighbours in a window 9 wide and 7 high are
/// less than the centre, in reading order, 31 in each half. Rows are read from column −4 on and,
/// like the codes, up to the next multiple of kLaneMultiple; 4 columns more are read there.
void census_code_row(const CensusRows& rows, int width, std::uint32_t* first_half,
                     std::uint32_t* second_half);
void census_code_row_ref(const CensusRows& rows, int width, std::uint32_t* first_half,
                         std::uint32_t* second_half);

/// Planes: the two halves of census codes.
using CensusPairs = FeaturePairs<std::uint32_t, 2>;

/// Hamming distances of codes, 0..62. Of three channels: the mean. Writes columns × lanes floats,
/// identical on every instruction set.
void hamming_row(const CensusPairs& row, float* cells);
void hamming_row_ref(const CensusPairs& row, float* cells);

}  // namespace vantage::kernels
