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

/// Neighbours of ray census codes: 1 to 4 px up, down, left and right, 1 and 2 px along diagonals.
/// Most are near the centre, where windows do not reach across edges; a few are farther, where
/// texture is coarse.
inline constexpr int kRayCensusRadius = 4;
inline constexpr int kRayCensusNeighbours = 24;

struct PixelOffset {
  int columns = 0;  ///< to the right
  int rows = 0;     ///< down
};
/// In reading order.
inline constexpr std::array<PixelOffset, kRayCensusNeighbours> kRayCensusOffsets = {
    {{0, -4}, {0, -3}, {-2, -2}, {0, -2}, {2, -2}, {-1, -1}, {0, -1}, {1, -1},
     {-4, 0}, {-3, 0}, {-2, 0},  {-1, 0}, {1, 0},  {2, 0},   {3, 0},  {4, 0},
     {-1, 1}, {0, 1},  {1, 1},   {-2, 2}, {0, 2},  {2, 2},   {0, 3},  {0, 4}}};

/// Rows y − 4 … y + 4 of an image.
using RayCensusRows = std::array<const float*, 2 * kRayCensusRadius + 1>;

/// A neighbour is compared with the centre, or with the centre and what is this many grey levels
/// less and more: neighbours that differ by noise are then told from those that differ. Grey levels
/// of 8-bit pixels are multiples of a thousandth at the finest, so rounding never decides.
inline constexpr float kRayCensusMargin = 1.2505F;
inline constexpr int kMostRayCensusThresholds = 3;

/// Each byte holds a bit of 8 neighbours, so that a vector of bytes compares as many candidates.
inline constexpr int kRayCensusBytes = kRayCensusNeighbours / 8;
inline constexpr int kMostRayCensusBytes = 2 * kRayCensusBytes;
/// Bytes of a code. thresholds: 1 or 3.
constexpr int ray_census_bytes(int thresholds) {
  return thresholds == 1 ? kRayCensusBytes : kMostRayCensusBytes;
}
using RayCensusCodes = std::array<std::uint8_t*, kMostRayCensusBytes>;

/// Ray census codes of `width` pixels: how many thresholds a neighbour is less than, 0 and 1, or 0
/// to 3 of centre − kRayCensusMargin, centre and centre + kRayCensusMargin, as binary numbers. The
/// first three bytes hold the upper bits, less than the centre, the first eight neighbours in the
/// first; with three thresholds the other three hold the lower bits. Rows are read from column −4
/// on and, like the codes, up to the next multiple of kLaneMultiple; 4 columns more are read there.
/// thresholds: 1 or 3.
void ray_census_code_row(const RayCensusRows& rows, int width, int thresholds,
                         const RayCensusCodes& codes);
void ray_census_code_row_ref(const RayCensusRows& rows, int width, int thresholds,
                             const RayCensusCodes& codes);

/// Planes: the two halves of census codes.
using CensusPairs = FeaturePairs<std::uint32_t, 2>;
/// Planes: the bytes of ray census codes, as many as the thresholds need.
struct RayCensusPairs : FeaturePairs<std::uint8_t, kMostRayCensusBytes> {
  int thresholds = 1;  ///< 1 or 3
};

/// Hamming distances of codes, 0..62. Of three channels: the mean. Writes columns × lanes floats,
/// identical on every instruction set. Ray codes: kernels/ray_census.
void hamming_row(const CensusPairs& row, float* cells);
void hamming_row_ref(const CensusPairs& row, float* cells);

}  // namespace vantage::kernels
