#include "engine/refinement/region_grid.h"

#include <algorithm>

namespace vantage {

RegionGrid halved(const RegionGrid& fine) {
  RegionGrid coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) {
      float sum = 0;
      int known = 0;
      bool has_unknown = false;
      for (int row = 2 * y; row < std::min(2 * y + 2, fine.height); ++row) {
        for (int column = 2 * x; column < std::min(2 * x + 2, fine.width); ++column) {
          const std::size_t i = fine.index(column, row);
          has_unknown = has_unknown || fine.states[i] == RegionGrid::kUnknown;
          if (fine.states[i] == RegionGrid::kKnown) {
            sum += fine.values[i];
            ++known;
          }
        }
      }
      const std::size_t i = coarse.index(x, y);
      if (known > 0) {
        coarse.states[i] = RegionGrid::kKnown;
        coarse.values[i] = sum / static_cast<float>(known);
      } else if (has_unknown) {
        coarse.states[i] = RegionGrid::kUnknown;
      }
    }
  }
  return coarse;
}

void interpolate_unknown(const RegionGrid& coarse, RegionGrid& fine) {
  for (int y = 0; y < fine.height; ++y) {
    const int row = y / 2;
    const int row_beside = std::clamp(y % 2 == 0 ? row - 1 : row + 1, 0, coarse.height - 1);
    for (int x = 0; x < fine.width; ++x) {
      const std::size_t i = fine.index(x, y);
      if (fine.states[i] != RegionGrid::kUnknown) {
        continue;
      }
      const int column = x / 2;
      const int beside = std::clamp(x % 2 == 0 ? column - 1 : column + 1, 0, coarse.width - 1);
      float sum = 0;
      float weights = 0;
      const auto add = [&](int from_x, int from_y, float weight) {
        const std::size_t from = coarse.index(from_x, from_y);
        if (coarse.states[from] != RegionGrid::kAbsent) {
          sum += weight * coarse.values[from];
          weights += weight;
        }
      };
      add(column, row, 9);  // never absent
      add(beside, row, 3);
      add(column, row_beside, 3);
      add(beside, row_beside, 1);
      fine.values[i] = sum / weights;
    }
  }
}

}  // namespace vantage
