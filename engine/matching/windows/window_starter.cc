#include "engine/matching/windows/window_starter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "engine/image/repeated_columns.h"
#include "kernels/window_start/window_start.h"

namespace vantage {
namespace {

using kernels::kNoSecondWinner;
using kernels::kWindowCandidates;
using kernels::WindowCells;

/// Candidates of a window before the guess.
constexpr int kBeforeGuess = kWindowCandidates / 2 - 1;

}  // namespace

WindowStarter::WindowStarter(const CoarseBeliefs& coarse, int spacing, int disparity_min, int count,
                             const kernels::WindowPrior& prior, double nats_per_step)
    : coarse_(coarse),
      spacing_(spacing),
      count_(count),
      coarse_columns_(coarse.extent().columns),
      first_(spacing * coarse.disparity_min() - disparity_min),
      lanes_(prior.lanes),
      steps_(static_cast<std::uint16_t>(
          std::min(65535.0, std::ceil(256 * coarse.nats_per_step() / nats_per_step)))),
      ceiling_(static_cast<std::uint8_t>(prior.ceiling / kernels::kWindowTotalUnits)),
      winners_{WindowValues<std::int16_t>(coarse_columns_),
               WindowValues<std::int16_t>(coarse_columns_),
               WindowValues<std::int16_t>(coarse_columns_)},
      second_(coarse_columns_),
      first_coarse_(coarse_columns_),
      starts_(coarse_columns_),
      offset_bits_(coarse_columns_),
      has_second_(coarse_columns_),
      energies_(coarse_columns_),
      support_(coarse_columns_) {}

void WindowStarter::load_winners(int y, WindowValues<std::int16_t>& row) const {
  std::int16_t* const winners = row.data();
  coarse_.winners_row(std::clamp(y, 0, coarse_.extent().rows - 1), winners);
  winners[-1] = winners[0];
  winners[coarse_columns_] = winners[coarse_columns_ - 1];
}

void WindowStarter::make_row(int y, scheduler::Range columns, WindowStartRow& row) {
  if (winners_y_ == y - 1) {
    std::rotate(winners_.begin(), winners_.begin() + 1, winners_.end());
    load_winners(y + 1, winners_[2]);
  } else {
    for (int i = 0; i < 3; ++i) {
      load_winners(y - 1 + i, winners_[static_cast<std::size_t>(i)]);
    }
  }
  winners_y_ = y;
  const int first = columns.begin / 2;
  kernels::second_winners_row(
      {winners_[0].data() + first, winners_[1].data() + first, winners_[2].data() + first},
      (columns.end + 1) / 2 - first, second_.data() + first);
  make_windows(y, winners_[1].data(), 0, columns, row);
  make_windows(y, second_.data(), 1, columns, row);
}

void WindowStarter::make_windows(int y, const std::int16_t* winners, std::size_t window,
                                 scheduler::Range columns, WindowStartRow& row) {
  // Copies: stores cannot alias them.
  const int begin = columns.begin / 2;
  const int end = (columns.end + 1) / 2;
  const auto last_start = static_cast<std::int16_t>(std::max(0, count_ - kWindowCandidates));
  const auto first = static_cast<std::int16_t>(first_);
  const auto spacing = static_cast<std::int16_t>(spacing_);
  const int halvings = spacing_ - 1;
  std::int16_t* const starts = starts_.data();
  std::int16_t* const first_coarse = first_coarse_.data();
  std::uint8_t* const offset_bits = offset_bits_.data();
  // In 16 bits, which compilers find vectors for. Without a second winner the window is unused.
  for (int x = begin; x < end; ++x) {
    const auto guess = static_cast<std::int16_t>(spacing * winners[x] + first - kBeforeGuess);
    const std::int16_t start = std::min(std::max(guess, std::int16_t{0}), last_start);
    // first ≤ 0: the coarser level begins at or before this one.
    const auto from_first = static_cast<std::int16_t>(start - first);
    starts[x] = start;
    const auto at_start = static_cast<std::int16_t>(from_first >> halvings);
    first_coarse[x] = winners[x] == kNoSecondWinner ? kNoSecondWinner : at_start;
    offset_bits[x] = static_cast<std::uint8_t>((from_first & halvings) << 3);
  }
  const bool exists =
      window == 0 || std::any_of(winners + begin, winners + end,
                                 [](std::int16_t winner) { return winner != kNoSecondWinner; });
  WindowCells* const support = row.support.cells[window].data();
  std::uint8_t* const marks = has_second_.data();
  if (window == 1) {
    for (int x = begin; x < end; ++x) {
      marks[x] = winners[x] == kNoSecondWinner ? 0 : 255;
    }
    repeat_columns(marks, columns, row.has_second.data());
    if (!exists) {
      std::fill_n(support + columns.begin, columns.size(), WindowCells{0});
      std::fill_n(row.start[1].data() + columns.begin, columns.size(), std::int16_t{0});
      return;
    }
  }
  coarse_.energies_row(y, {begin, end}, first_coarse_.data(), kernels::coarse_candidates(spacing_),
                       energies_.data());
  kernels::window_start_row({.spacing = spacing_,
                             .energies = energies_.data() + begin,
                             .offset_bits = offset_bits_.data() + begin,
                             .steps = steps_,
                             .ceiling = ceiling_,
                             .lanes = lanes_,
                             .columns = end - begin},
                            support_.data() + begin);
  if (window == 1) {
    WindowCells* const of_second = support_.data();
    for (int x = begin; x < end; ++x) {
      of_second[x] = marks[x] == 0 ? 0 : of_second[x];
    }
  }
  repeat_columns(support_.data(), columns, support);
  repeat_columns(starts_.data(), columns, row.start[window].data());
}

void WindowStarter::mark_near(const WindowStartRow* above, const WindowStartRow* below,
                              scheduler::Range columns, WindowStartRow& row) {
  const std::uint8_t* const own = row.has_second.data();
  std::uint8_t* const near = row.near_second.data();
  for (int x = columns.begin; x < columns.end; ++x) {
    near[x] = own[x - 1] | own[x] | own[x + 1];
  }
  for (const WindowStartRow* const beside : {above, below}) {
    if (beside != nullptr) {
      const std::uint8_t* const of_beside = beside->has_second.data();
      for (int x = columns.begin; x < columns.end; ++x) {
        near[x] |= of_beside[x];
      }
    }
  }
}

}  // namespace vantage
