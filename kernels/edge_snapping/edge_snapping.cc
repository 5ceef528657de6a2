#include "kernels/edge_snapping/edge_snapping.h"

#include <algorithm>
#include <cmath>

namespace vantage::kernels {
namespace {

constexpr float kSurfaceStepPx = 1;

/// First discontinuity at or to the right of `place`; width − 1 if there is none.
int next_discontinuity(const float* disparity_px, int place, int width) {
  while (place + 1 < width &&
         !(std::abs(disparity_px[place + 1] - disparity_px[place]) > kSurfaceStepPx)) {
    ++place;
  }
  return place;
}

struct Row {
  const std::uint8_t* edges;
  const float* disparity_px;

  [[nodiscard]] bool is_at_edge(int place) const {
    return edges[place] != 0 || edges[place + 1] != 0;
  }
  [[nodiscard]] bool is_known(int column) const { return !std::isnan(disparity_px[column]); }
};

/// New position of the discontinuity at `place`, strictly between `first` and `last`.
int nearest_edge(const Row& row, int place, int first, int last, int max_px) {
  if (row.is_at_edge(place)) {
    return place;
  }
  bool may_go_left = true;
  bool may_go_right = true;
  for (int move = 1; move <= max_px; ++move) {
    may_go_left = may_go_left && place - move > first && row.is_known(place - move + 1);
    if (may_go_left && row.is_at_edge(place - move)) {
      return place - move;
    }
    may_go_right = may_go_right && place + move < last && row.is_known(place + move);
    if (may_go_right && row.is_at_edge(place + move)) {
      return place + move;
    }
  }
  return place;
}

}  // namespace

void snap_discontinuities_row(const std::uint8_t* edges, int max_px, int width,
                              float* disparity_px) {
  const int end = width - 1;  // positions are to its left
  int first = -1;
  for (int place = next_discontinuity(disparity_px, 0, width); place < end;) {
    // Found before this one moves: the next one does not move until its own turn.
    const int next = next_discontinuity(disparity_px, place + 1, width);
    const int moved = nearest_edge({edges, disparity_px}, place, first, next, max_px);
    if (moved < place) {
      std::fill(disparity_px + moved + 1, disparity_px + place + 1, disparity_px[place + 1]);
    } else {
      std::fill(disparity_px + place + 1, disparity_px + moved + 1, disparity_px[place]);
    }
    first = std::max(place, moved);
    place = next;
  }
}

}  // namespace vantage::kernels
