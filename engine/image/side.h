#pragma once

#include <cstddef>

namespace vantage {

/// Left or right image of a pair, or its camera: the grid a map is on, and the side on which the
/// background of an occlusion lies.
enum class Side { kLeft, kRight };

/// Index into arrays ordered left, right.
constexpr std::size_t index_of(Side side) { return side == Side::kLeft ? 0 : 1; }

constexpr Side other_side(Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; }

/// The partner of column x is x + direction_of(side) · d in the other image.
constexpr int direction_of(Side side) { return side == Side::kLeft ? -1 : 1; }

}  // namespace vantage
