#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage {

/// A region of pixels whose values are sought, with known ones around it, on a grid of its own.
struct RegionGrid {
  enum State : std::uint8_t {
    kAbsent,   ///< not part of the surface
    kUnknown,  ///< sought
    kKnown     ///< an end of the surface
  };
  int width = 0;
  int height = 0;
  std::vector<State> states;  ///< row by row
  std::vector<float> values;  ///< of known cells; of unknown ones an estimate; else undefined

  RegionGrid(int columns, int rows)
      : width(columns), height(rows), states(size(), kAbsent), values(size(), 0.0F) {}

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// A grid of half the size (rounded up): a cell of 2×2 is known, with the mean of its known values,
/// if it has some, otherwise unknown if it has unknown ones.
RegionGrid halved(const RegionGrid& fine);

/// Estimates the unknown values of `fine` from those of halved(fine), bilinearly between centres of
/// cells.
void interpolate_unknown(const RegionGrid& coarse, RegionGrid& fine);

}  // namespace vantage
