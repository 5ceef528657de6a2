#pragma once

#include <algorithm>

namespace vantage::kernels {

/// Cell columns are padded to a multiple of this many lanes (disparities) on every instruction set,
/// so the layout of the disparity space does not depend on the processor.
inline constexpr int kLaneMultiple = 16;

/// Half-open interval of candidate indices.
struct CandidateRange {
  int begin = 0;
  int end = 0;
  [[nodiscard]] bool empty() const { return end <= begin; }
  friend bool operator==(CandidateRange, CandidateRange) = default;
};

/// The candidates of a disparity space over an image `width` columns wide: index i in
/// [0, count) stands for disparity_px = (disparity_min + i) / steps_per_px. The partner of
/// reference column x is x + direction · disparity_px in the other image: direction is −1 when the
/// reference is the left image and +1 when it is the right one (EQUATIONS §0).
struct CandidateGeometry {
  int width = 0;
  int disparity_min = 0;  ///< in steps
  int count = 0;
  int direction = -1;
  int steps_per_px = 1;  ///< candidates per pixel of disparity, ≥ 1

  [[nodiscard]] int lanes() const {
    return (count + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
  }
  /// Column of the partner, in steps.
  [[nodiscard]] int partner(int x, int candidate) const {
    return steps_per_px * x + direction * (disparity_min + candidate);
  }
  /// Candidates of column x whose partner lies in columns [margin, width − margin) of the other
  /// image. With margin = window radius: candidates whose whole window has partners.
  [[nodiscard]] CandidateRange with_partner(int x, int margin = 0) const {
    return with_partners(x, x, margin);
  }
  /// Candidates for which every column first..last has a partner inside the other image.
  [[nodiscard]] CandidateRange with_partners(int first, int last, int margin = 0) const {
    const int low = steps_per_px * margin;
    const int high = steps_per_px * (width - 1 - margin);
    const int first_step = steps_per_px * first;
    const int last_step = steps_per_px * last;
    // direction −1: low ≤ first − d and last − d ≤ high; direction +1: likewise with + d.
    const int min = direction < 0 ? last_step - high : low - first_step;
    const int max = direction < 0 ? first_step - low : high - last_step;
    return {std::clamp(min - disparity_min, 0, count),
            std::clamp(max - disparity_min + 1, 0, count)};
  }
  /// Columns [begin, end) where every candidate has a partner for all columns within `radius` that
  /// lie in the reference image. `begin` may exceed `end`; both may exceed the image width.
  [[nodiscard]] CandidateRange columns_with_all_partners(int radius = 0) const {
    // partner = x − shift for shifts in [min, max], which are widened to whole columns.
    const int min_steps = direction < 0 ? disparity_min : -(disparity_min + count - 1);
    const int min = whole_columns(min_steps);
    const int max = -whole_columns(-(min_steps + count - 1));
    return {max > 0 ? max + radius : 0, min < 0 ? width + min - radius : width};
  }
  /// Whole columns in a number of steps, rounded down.
  [[nodiscard]] int whole_columns(int steps) const {
    const int columns = steps / steps_per_px;
    return columns - (columns * steps_per_px > steps ? 1 : 0);
  }
};

/// Layout of a cell column whose candidates are two-dimensional displacements: `rows` contiguous
/// runs, one per vertical displacement, of `row_candidates` horizontal displacements each.
struct CandidatePlane {
  int row_candidates = 0;  ///< 0: one-dimensional search
  int rows = 0;

  [[nodiscard]] bool is_given() const { return row_candidates > 0; }
  [[nodiscard]] int count() const { return row_candidates * rows; }
  /// Lanes of one run, padded to whole vectors.
  [[nodiscard]] int row_lanes() const { return CandidateGeometry{.count = row_candidates}.lanes(); }
  /// Cells of working memory to smooth one column in both directions: its runs with `margin` cells
  /// around each, the smoothed runs, and the column.
  [[nodiscard]] int work_cells(int margin) const {
    return margin + rows * (row_lanes() + margin) + rows * row_lanes() +
           CandidateGeometry{.count = count()}.lanes() + kLaneMultiple;
  }
};

}  // namespace vantage::kernels
