#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "scheduler/range.h"

namespace vantage {

/// The luma (Rec. 601) of a photograph in integer grey levels 0..255, for comparing frames. Memory
/// of `intensities` is reused. Identical for any `execution`.
void luma_intensity(const Photograph& photograph, Execution& execution,
                    Image<std::uint8_t>& intensities);

/// Finds the pixels whose image did not change from one frame to the next: the mean difference over
/// 3×3 pixels is at most `threshold` grey levels, at the pixel and its eight neighbours. (Means
/// suppress the noise of single differences; a moving surface changes them at its texture and its
/// outline.)
class StillPixels {
 public:
  /// Throws UsageError unless the threshold is a number of grey levels, 0..255.
  explicit StillPixels(double threshold);

  /// still: 255 where nothing changed, else 0. Both images of equal size; memory of `still` is
  /// reused. Returns the number of still pixels. Identical for any `execution`. Thread rule: may be
  /// called concurrently for different results.
  std::int64_t find(const Image<std::uint8_t>& before, const Image<std::uint8_t>& now,
                    Execution& execution, Mask& still) const;
  /// Those of some rows of `still`, which has the size of the images.
  void find_in_rows(const Image<std::uint8_t>& before, const Image<std::uint8_t>& now,
                    scheduler::Range rows, Execution& execution, Mask& still) const;

 private:
  std::int16_t limit_;  ///< of sums over 3×3 pixels
};

}  // namespace vantage
