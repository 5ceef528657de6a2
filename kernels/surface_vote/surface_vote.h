#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Most surfaces that vote on one place: whole vectors.
constexpr std::size_t kMaxVoters = 96;
/// Votes are counted in steps of this share of a pixel.
constexpr int kVoteStepsPerPx = 64;

/// Planes beside a place, one value of each per voter. Values from `count` to the next multiple of
/// 16 must be finite.
struct SurfaceVoters {
  template <typename T>
  using Values = std::array<T, kMaxVoters>;

  std::size_t count = 0;
  alignas(64) Values<float> disparity_px{};  ///< at (x, y)
  alignas(64) Values<float> slope_x{};       ///< pixels of disparity per column
  alignas(64) Values<float> slope_y{};
  alignas(64) Values<float> x{};
  alignas(64) Values<float> y{};
  alignas(64) Values<float> weight{};                        ///< ≥ 0, before distance and colour
  alignas(64) std::array<Values<std::int32_t>, 3> colour{};  ///< 0..255

  /// The plane of a voter at a place.
  [[nodiscard]] float at(std::size_t voter, float place_x, float place_y) const {
    return disparity_px[voter] + slope_x[voter] * (place_x - x[voter]) +
           slope_y[voter] * (place_y - y[voter]);
  }
};

/// A row of the other camera's map, NaN = unknown.
struct SeenRow {
  const float* disparity_px = nullptr;
  int width = 0;
  float columns_per_px =
      -1;  ///< from a pixel to its partner, per pixel of disparity; negative: left
};

/// What the other camera sees at the partner of column x; NaN outside its image, or unknown.
float seen_at(const SeenRow& row, float x, float disparity_px);

/// The place to vote on.
struct VotePlace {
  float x = 0;
  float y = 0;
  std::array<std::int32_t, 3> colour{};  ///< 0..255
  SeenRow seen;
  float min_px = 0;  ///< planes are limited to this range; |value| < 2²⁴
  float max_px = 0;
};

struct VotedSurface {
  std::size_t voter = kMaxVoters;  ///< kMaxVoters: nobody voted
  float disparity_px = 0;          ///< in whole kVoteStepsPerPx
  float agreement = 0;             ///< share of the weight within 1 px of it
};

/// The surface at a place. Each plane votes for its disparity there. Its weight counts less with
/// the distance r in pixels, 1/(r + 4)², with the sum s of absolute differences of channels,
/// exp(−s/25) (filled_median.h), and a tenth if it would hide what the other camera sees: something
/// farther by more than 1 px. The weighted median wins, if the other camera sees it within 1 px or
/// nothing is known there; else the lower quartile, because the place is hidden from that camera.
/// Of voters for the winning step, the one of most weight. Weights are whole multiples of 2⁻²⁰ of
/// the largest, so sums are exact: identical on every instruction set.
VotedSurface vote_on_surface(const SurfaceVoters& voters, const VotePlace& place);

}  // namespace vantage::kernels
