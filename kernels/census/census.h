#pragma once

#include <array>
#include <cstdint>

#include "kernels/feature_pairs.h"

namespace vantage::kernels {

/// The window of census codes.
inline constexpr int kCensusRadiusX = 4;
inline constexpr int kCensusRadiusY = 3;
/// Neighbours in it, each a bit.
inline constexpr int kCensusBits = 62;

/// Rows y − 3 … y + 3 of an image.
using CensusRows = std::array<const float*, 2 * kCensusRadiusY + 1>;

/// Census codes of `width` pixels: which of the 62 neighbours in a window 9 wide and 7 high are
/// less than the centre, in reading order, 31 in each half. Rows are read from column −4 on and,
/// like the codes, up to the next multiple of kLaneMultiple; 4 columns more are read there.
void census_code_row(const CensusRows& rows, int width, std::uint32_t* first_half,
                     std::uint32_t* second_half);
void census_code_row_ref(const CensusRows& rows, int width, std::uint32_t* first_half,
                         std::uint32_t* second_half);

/// The small window of census codes: 5×5.
inline constexpr int kSmallCensusRadius = 2;
inline constexpr int kSmallCensusBits = 24;

/// Rows y − 2 … y + 2 of an image.
using SmallCensusRows = std::array<const float*, 2 * kSmallCensusRadius + 1>;

/// A code's 24 bits, 8 to a byte, so that a vector of bytes compares as many candidates.
inline constexpr int kSmallCensusBytes = 3;
using SmallCensusCodes = std::array<std::uint8_t*, kSmallCensusBytes>;

/// The same with the 24 neighbours in a window of 5×5, the first eight in the first byte. Rows are
/// read from column −2 on, up to the next multiple of kLaneMultiple and 2 columns more.
void small_census_code_row(const SmallCensusRows& rows, int width, const SmallCensusCodes& codes);
void small_census_code_row_ref(const SmallCensusRows& rows, int width,
                               const SmallCensusCodes& codes);

/// Planes: the two halves of census codes.
using CensusPairs = FeaturePairs<std::uint32_t, 2>;
/// Planes: the bytes of small census codes.
using SmallCensusPairs = FeaturePairs<std::uint8_t, kSmallCensusBytes>;

/// Hamming distances of codes, 0..62. Of three channels: the mean. Writes columns × lanes floats,
/// identical on every instruction set. Small codes: kernels/small_census.
void hamming_row(const CensusPairs& row, float* cells);
void hamming_row_ref(const CensusPairs& row, float* cells);

}  // namespace vantage::kernels
