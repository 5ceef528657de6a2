#pragma once

#include <algorithm>
#include <cmath>

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
  /// Several other images, whose partners are x + direction · disparity_px · ratio: the smallest
  /// ratio of those on the side of the first (≤ 1), and the smallest magnitude of those on the
  /// other side (0: none). A candidate then has a partner if it has one in any image.
  double near_ratio = 1;
  double opposite_ratio = 0;

  /// Whether there is one other image.
  [[nodiscard]] bool is_of_one() const { return near_ratio == 1 && opposite_ratio == 0; }
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
    if (!is_of_one()) {
      const CandidateRange of_first = in_any_image(first, margin);
      const CandidateRange of_last = in_any_image(last, margin);
      return {std::max(of_first.begin, of_last.begin), std::min(of_first.end, of_last.end)};
    }
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
    if (!is_of_one()) {
      return columns_with_all_in_any_image(radius);
    }
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

 private:
  /// Ratios are inexact: partners may lie this far outside, in pixels.
  static constexpr double kRounding = 1e-6;

  /// Candidates of column x whose partner lies inside at least one of several images. Those of one
  /// image are an interval with disparity 0 in it, so those of all are one, too.
  [[nodiscard]] CandidateRange in_any_image(int x, int margin) const {
    const double to_first = x - margin;
    const double to_last = width - 1 - margin - x;
    if (to_first < 0 || to_last < 0) {
      return {};
    }
    // Room along growing and along falling disparities in the first image.
    const double room = direction < 0 ? to_first : to_last;
    const double other_room = direction < 0 ? to_last : to_first;
    const auto reach_px = [&](double near, double opposite) {
      const double reach = (near + kRounding) / near_ratio;
      return opposite_ratio > 0 ? std::max(reach, (opposite + kRounding) / opposite_ratio) : reach;
    };
    const auto steps_within = [&](double reach) {
      return static_cast<int>(std::min(std::floor(reach * steps_per_px), 1e9));
    };
    return {std::clamp(-steps_within(reach_px(other_room, room)) - disparity_min, 0, count),
            std::clamp(steps_within(reach_px(room, other_room)) - disparity_min + 1, 0, count)};
  }
  /// At most those of columns_with_all_partners(): where cameras on both sides leave out columns in
  /// the middle, only those on one side of them.
  [[nodiscard]] CandidateRange columns_with_all_in_any_image(int radius) const {
    const double max_px = static_cast<double>(disparity_min + count - 1) / steps_per_px;
    const double min_px = static_cast<double>(disparity_min) / steps_per_px;
    // Columns from the border that the first image lacks, less those that the other side has.
    const auto missing = [&](double px) {
      const double enough = std::ceil(near_ratio * px);
      const double of_other = opposite_ratio > 0 ? std::floor(width - opposite_ratio * px) : 0;
      const bool has_all = std::max(of_other, 0.0) >= enough;
      return has_all ? 0 : static_cast<int>(std::min<double>(enough, width)) + radius;
    };
    const int before = missing(max_px);
    const int after = missing(-min_px);
    return direction < 0 ? CandidateRange{before, width - after}
                         : CandidateRange{after, width - before};
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
