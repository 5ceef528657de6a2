#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/matching/costs/cost_planes.h"
#include "engine/matching/windows/window_format.h"
#include "engine/matching/windows/window_level.h"
#include "engine/matching/windows/window_rows.h"
#include "kernels/candidate_windows.h"
#include "kernels/candidates.h"
#include "kernels/census/census.h"
#include "scheduler/range.h"

namespace vantage {

/// Evidence of the candidates in the windows of a level, and which of them have partners. Thread
/// rule: immutable.
class WindowEvidence {
 public:
  /// `input` and `format` must outlive the object. columns: of the level. lanes: 255 for those of a
  /// window that are candidates.
  WindowEvidence(const WindowLevelInput& input, const WindowFormat& format, int columns,
                 kernels::WindowCells lanes);

  /// The evidence of `columns` of row y; the first one is even, or 0. 0 for candidates without
  /// partners for all pixels of the column.
  void make_row(int y, scheduler::Range columns, const WindowStartRow& starts,
                WindowCellsRow& evidence) const;

  /// 255 for the candidates of a window of column x, which begins at `start`, that have partners
  /// for all pixels of the column.
  [[nodiscard]] kernels::WindowCells with_partner(int x, int start) const {
    const kernels::CandidateRange inside = partnered_[static_cast<std::size_t>(x)];
    return lanes_before(inside.end - start) & ~lanes_before(inside.begin - start);
  }
  /// Whether all candidates have partners in all columns.
  [[nodiscard]] bool has_all_partners() const {
    return inner_ == scheduler::Range{0, static_cast<int>(partnered_.size())};
  }
  /// Calls body(x) for those of `columns` where some candidates lack partners.
  template <typename Body>
  void for_each_outer_column(scheduler::Range columns, const Body& body) const {
    for (int x = columns.begin; x < std::min(inner_.begin, columns.end); ++x) {
      body(x);
    }
    for (int x = std::max({inner_.begin, inner_.end, columns.begin}); x < columns.end; ++x) {
      body(x);
    }
  }

 private:
  /// Planes of the codes of one channel.
  using Codes = PlaneSet<std::uint8_t, kernels::kMaxRayCensusBytes>;

  static const Codes& codes_of(const CostImage& image);
  /// 255 for the first `count` lanes.
  static kernels::WindowCells lanes_before(int count) {
    const int lanes = std::clamp(count, 0, kernels::kWindowCandidates);
    return lanes == kernels::kWindowCandidates ? ~kernels::WindowCells{0}
                                               : (kernels::WindowCells{1} << (8 * lanes)) - 1;
  }
  void add_prior(int y, scheduler::Range columns, const WindowStartRow& starts,
                 const std::array<kernels::WindowCells*, kernels::kWindows>& evidence) const;

  const WindowLevelInput& input_;
  const WindowFormat& format_;
  const Codes& reference_;
  const Codes& partner_;
  kernels::WindowCells lanes_;
  scheduler::Range inner_;  ///< columns where all candidates have partners
  /// Per column: the candidates that have partners for all of its pixels.
  std::vector<kernels::CandidateRange> partnered_;
};

}  // namespace vantage
