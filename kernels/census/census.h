#pragma once

#include <array>
#include <cstdint>

#include "kernels/feature_pairs.h"

namespace vantage::kernels {

/// Radii of the window of census codes.
inline constexpr int kCensusRadiusX = 4;
inline constexpr int kCensusRadiusY = 3;
/// Neighbours in the window, one bit each.
inline constexpr int kCensusBits = 62;

/// Rows y − 3 … y + 3 of an image.
using CensusRows = std::array<const float*, 2 * kCensusRadiusY + 1>;

/// Census codes of `width` pixels: which of the 62 neighbours in a 9×7 window are less than the
/// centre, in reading order, 31 in each half. Rows are read from column −4 on, up to 4 columns
/// after the next multiple of kLaneMultiple; codes are written up to that multiple.
void census_code_row(const CensusRows& rows, int width, std::uint32_t* first_half,
                     std::uint32_t* second_half);

/// Neighbours of ray census codes: 1 to 4 px up, down, left and right, 1 and 2 px along diagonals.
/// Most are near the centre, where windows do not reach across edges; a few are farther, for coarse
/// texture.
inline constexpr int kRayCensusRadius = 4;
inline constexpr int kRayCensusNeighbours = 24;

struct PixelOffset {
  int columns = 0;  ///< positive to the right
  int rows = 0;     ///< positive downwards
};
/// In reading order.
inline constexpr std::array<PixelOffset, kRayCensusNeighbours> kRayCensusOffsets = {
    {{0, -4}, {0, -3}, {-2, -2}, {0, -2}, {2, -2}, {-1, -1}, {0, -1}, {1, -1},
     {-4, 0}, {-3, 0}, {-2, 0},  {-1, 0}, {1, 0},  {2, 0},   {3, 0},  {4, 0},
     {-1, 1}, {0, 1},  {1, 1},   {-2, 2}, {0, 2},  {2, 2},   {0, 3},  {0, 4}}};

/// Rows y − 4 … y + 4 of an image.
using RayCensusRows = std::array<const float*, 2 * kRayCensusRadius + 1>;

/// With three thresholds a neighbour is compared with the centre and with the centre minus and plus
/// this many grey levels, which separates noise from real differences. Grey levels of 8-bit pixels
/// are multiples of 1/1000 or coarser, so rounding never decides.
inline constexpr float kRayCensusMargin = 1.2505F;
inline constexpr int kMaxRayCensusThresholds = 3;

/// Each byte holds one bit of 8 neighbours, so that a vector of bytes compares that many
/// candidates.
inline constexpr int kRayCensusBytes = kRayCensusNeighbours / 8;
inline constexpr int kMaxRayCensusBytes = 2 * kRayCensusBytes;
/// Bytes per code. thresholds: 1 or 3.
constexpr int ray_census_bytes(int thresholds) {
  return thresholds == 1 ? kRayCensusBytes : kMaxRayCensusBytes;
}
using RayCensusCodes = std::array<std::uint8_t*, kMaxRayCensusBytes>;

/// Ray census codes of `width` pixels: the number of thresholds that a neighbour is less than, as a
/// binary number. One threshold (the centre): 0 or 1. Three (centre − kRayCensusMargin, centre,
/// centre + kRayCensusMargin): 0 to 3. The first three bytes hold the upper bits (less than the
/// centre), the first eight neighbours in the first byte; with three thresholds the other three
/// hold the lower bits. Rows are read from column −4 on, up to 4 columns after the next multiple of
/// kLaneMultiple; codes are written up to that multiple. thresholds: 1 or 3.
void ray_census_code_row(const RayCensusRows& rows, int width, int thresholds,
                         const RayCensusCodes& codes);

/// As ray_census_code_row() with one threshold, of bytes.
using ByteRayCensusRows = std::array<const std::uint8_t*, 2 * kRayCensusRadius + 1>;
void byte_ray_census_code_row(const ByteRayCensusRows& rows, int width,
                              const RayCensusCodes& codes);

/// Planes: the two halves of census codes.
using CensusPairs = FeaturePairs<std::uint32_t, 2>;
/// Planes: the bytes of ray census codes, as many as `thresholds` requires.
struct RayCensusPairs : FeaturePairs<std::uint8_t, kMaxRayCensusBytes> {
  int thresholds = 1;  ///< 1 or 3
};

/// Hamming distances of codes, 0..62; with three channels their mean. Writes columns × lanes
/// floats. Identical on every instruction set. Ray codes: kernels/ray_census.
void hamming_row(const CensusPairs& row, float* cells);

}  // namespace vantage::kernels
