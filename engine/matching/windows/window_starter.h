#pragma once

#include <array>
#include <cstdint>

#include "engine/matching/windows/coarse_beliefs.h"
#include "engine/matching/windows/window_rows.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Chooses the windows of a level from the coarser one and converts its energies to their start.
/// Working memory of one task.
class WindowStarter {
 public:
  /// spacing: the level's candidates from one coarse candidate to the next, 1 or 2. disparity_min,
  /// count: of the level's candidates.
  WindowStarter(const CoarseBeliefs& coarse, int spacing, int disparity_min, int count,
                const kernels::WindowPrior& prior, double nats_per_step);

  /// Everything but near_second of the level's rows that coarse row y covers; `columns` of the
  /// level, the first one even.
  void make_row(int y, scheduler::Range columns, WindowStartRow& row);
  /// near_second of `row`; `above` and `below`: those of the coarse rows beside it, null outside.
  static void mark_near(const WindowStartRow* above, const WindowStartRow* below,
                        scheduler::Range columns, WindowStartRow& row);

 private:
  void load_winners(int y, WindowValues<std::int16_t>& row) const;
  /// The windows around `winners`, kNoSecondWinner: none.
  void make_windows(int y, const std::int16_t* winners, std::size_t window,
                    scheduler::Range columns, WindowStartRow& row);

  const CoarseBeliefs& coarse_;
  int spacing_;
  int count_;
  int coarse_columns_;
  /// Candidate of the level at the disparity of the coarser level's candidate 0.
  int first_;
  kernels::WindowCells lanes_;
  std::uint16_t steps_;
  std::uint8_t ceiling_;
  std::array<WindowValues<std::int16_t>, 3> winners_;  ///< of three rows
  int winners_y_ = -2;                                 ///< row of winners_[1]
  WindowValues<std::int16_t> second_;
  WindowValues<std::int16_t> first_coarse_;
  WindowValues<std::int16_t> starts_;
  WindowValues<std::uint8_t> offset_bits_;
  WindowValues<std::uint8_t> has_second_;  ///< 255 or 0
  WindowValues<kernels::WindowCells> energies_;
  WindowValues<kernels::WindowCells> support_;
};

}  // namespace vantage
