#include <algorithm>
#include <cstdint>

#include "kernels/still_pixels/still_pixels.h"

namespace vantage::kernels {

void still_view_row(const std::uint8_t* still, int width, int min_shift, int max_shift,
                    std::uint8_t* still_view) {
  const auto clear = [&](int begin, int end) {
    begin = std::clamp(begin, 0, width);
    std::fill(still_view + begin, still_view + std::clamp(end, begin, width), std::uint8_t{0});
  };
  std::fill_n(still_view, width, std::uint8_t{255});
  // Positions whose shifts all lead out of the image.
  clear(0, -max_shift);
  clear(width - min_shift, width);
  const std::uint8_t* const end = still + width;
  for (const std::uint8_t* run = std::find(still, end, 0); run != end;
       run = std::find(run, end, 0)) {
    const auto first = static_cast<int>(run - still);
    run = std::find(run, end, 255);
    clear(first - max_shift, static_cast<int>(run - still) - min_shift);
  }
}

}  // namespace vantage::kernels
