#pragma once

#include <cstddef>
#include <vector>

#include "engine/execution.h"
#include "engine/image/photograph.h"

namespace vantage {

/// A photograph's luma in whole grey levels, and halves of it: each reduction halves width and
/// height, rounded up, by means of 2×2 pixels (EQUATIONS §3.13). Whole grey levels, because census
/// codes of unrounded means would compare noise. Working memory, reused without reallocation.
class ReducedImages {
 public:
  /// Identical for any `execution`.
  void prepare(const Photograph& photograph, int reductions, Execution& execution);

  /// 8-bit grey; 0: full size.
  [[nodiscard]] const Photograph& reduced(int reductions) const {
    return images_[static_cast<std::size_t>(reductions)];
  }
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  std::vector<Photograph> images_;
};

}  // namespace vantage
