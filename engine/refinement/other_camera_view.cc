#include "engine/refinement/other_camera_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/refinement/refinement.h"
#include "kernels/row_bits/row_bits.h"

namespace vantage {

void keep_matched(ImageView<const float> map_px, double tolerance_px, Execution& execution,
                  Mask& unmatched, OtherCameraView& other) {
  const int width = map_px.width();
  cross_check(other.map_px, map_px, other_side(other.side), tolerance_px, execution, unmatched,
              other.columns_per_px);
  other.matched.resize(kernels::row_words(width), map_px.height());
  execution.for_each_row(map_px.height(), [&](int y) {
    kernels::zero_bits_row(unmatched.row(y), width, other.matched.row(y));
  });
}

void copy_seen_row(const OtherCameraView& other, int y, float* seen_px) {
  const int width = other.map_px.width();
  const float* const map_px = other.map_px.row(y);
  const std::uint64_t* const matched = other.matched.row(y);
  float last_px = std::numeric_limits<float>::quiet_NaN();
  int begin = 0;  // of a run without matches
  const auto end_run = [&](int end, float next_px) {
    std::fill(seen_px + begin, seen_px + end, std::fmin(last_px, next_px));
  };
  for (int x = 0; x < width; ++x) {
    if ((matched[x / 64] >> (x % 64) & 1) == 0) {
      continue;
    }
    end_run(x, map_px[x]);
    last_px = seen_px[x] = map_px[x];
    begin = x + 1;
  }
  end_run(width, std::numeric_limits<float>::quiet_NaN());
}

}  // namespace vantage
