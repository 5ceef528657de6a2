#pragma once

#include <algorithm>

namespace vantage::kernels {

/// Which of the taps at −1, 0, 1 and 2 around a position stand for each of them: a tap outside the
/// image or on another surface takes the value of its neighbour towards the centre. Where neither
/// of the inner two is on the surface, all take that of the nearest one.
struct PlainTaps {
  int from[4];         ///< indices of taps
  bool is_on_surface;  ///< one of the inner two is
};

/// `first`: position of tap 0; `size`: of the image; `fraction`: of the position between the inner
/// two taps.
inline PlainTaps plain_taps(const bool (&on_surface)[4], int first, int size, float fraction) {
  if (!on_surface[1] && !on_surface[2]) {
    const int nearest = std::clamp(fraction < 0.5F ? 1 : 2, -first, size - 1 - first);
    return {{nearest, nearest, nearest, nearest}, false};
  }
  const int left = on_surface[1] ? 1 : 2;
  const int right = on_surface[2] ? 2 : 1;
  return {{on_surface[0] && on_surface[1] ? 0 : left, left, right,
           on_surface[3] && on_surface[2] ? 3 : right},
          true};
}

}  // namespace vantage::kernels
