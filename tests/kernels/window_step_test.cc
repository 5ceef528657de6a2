#include "kernels/window_step/window_step.h"

#include <array>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::window_step_test {

WindowCells random_cells(std::mt19937& random, int max) {
  WindowCells cells = 0;
  for (int k = 0; k < kWindowCandidates; ++k) {
    cells |= static_cast<WindowCells>(random_int(random, 0, max)) << (8 * k);
  }
  return cells;
}

/// Three rows of windows and everything else that a step reads, with margins.
struct StepCase {
  static constexpr std::size_t kBefore = kWindowMargin;

  struct Row {
    std::array<std::vector<WindowCells>, kWindows> support;
    std::array<std::vector<std::int16_t>, kWindows> start;
  };
  std::array<Row, 3> rows;
  std::array<std::vector<WindowCells>, kWindows> evidence;
  std::array<std::vector<WindowCells>, kWindows> selectable;
  std::vector<std::uint8_t> has_second, near_second;
  std::array<std::vector<FixedWeight>, 3> weights;
  WindowStepRow row;

  /// seconds: one of so many pairs of columns has a second window; 0: none.
  StepCase(std::mt19937& random, int columns, int seconds, int max, WindowPrior prior) {
    const auto size = static_cast<std::size_t>(columns) + 2 * kBefore;
    std::array<std::vector<std::uint8_t>, 3> exists;
    for (std::size_t r = 0; r < 3; ++r) {
      exists[r].resize(size);
      for (std::size_t q = 0; q < kWindows; ++q) {
        rows[r].support[q].resize(size);
        rows[r].start[q].resize(size);
      }
      for (std::size_t x = kBefore; x < kBefore + static_cast<std::size_t>(columns); ++x) {
        const bool is_left = x % 2 == 0;  // of a pair, which has the same windows
        exists[r][x] = !is_left ? exists[r][x - 1]
                       : seconds > 0 && random() % static_cast<unsigned>(seconds) == 0 ? 255
                                                                                       : 0;
        for (std::size_t q = 0; q < kWindows; ++q) {
          rows[r].support[q][x] = q == 0 || exists[r][x] != 0 ? random_cells(random, max) : 0;
          rows[r].start[q][x] = !is_left
                                    ? rows[r].start[q][x - 1]
                                    : static_cast<std::int16_t>(random_int(random, 0, 1) == 0
                                                                    ? random_int(random, 40, 44)
                                                                    : random_int(random, 0, 4000));
        }
      }
    }
    for (std::size_t q = 0; q < kWindows; ++q) {
      evidence[q].resize(size);
      selectable[q].resize(size);
      for (std::size_t x = 0; x < size; ++x) {
        evidence[q][x] = q == 0 || exists[1][x] != 0 ? random_cells(random, max) : 0;
        for (int k = 0; k < kWindowCandidates; ++k) {
          if (random() % 4 != 0 && x % 7 != 0) {
            selectable[q][x] |= WindowCells{255} << (8 * k);
          }
        }
      }
    }
    has_second = exists[1];
    near_second.resize(size);
    for (std::size_t x = 1; x + 1 < size; ++x) {
      near_second[x] =
          exists[0][x] | exists[1][x - 1] | exists[1][x] | exists[1][x + 1] | exists[2][x];
    }
    for (auto& of_weights : weights) {
      of_weights.resize(size);
      for (FixedWeight& weight : of_weights) {
        weight = static_cast<FixedWeight>(random_int(random, 0, 32767));
      }
    }
    const auto at = [](const auto& values) { return values.data() + kBefore; };
    const auto windows = [&](std::size_t r) -> WindowRow {
      return {{at(rows[r].support[0]), at(rows[r].support[1])},
              {at(rows[r].start[0]), at(rows[r].start[1])}};
    };
    row = {.up = windows(0),
           .centre = windows(1),
           .down = windows(2),
           .evidence = {at(evidence[0]), at(evidence[1])},
           .has_second = at(has_second),
           .near_second = at(near_second),
           .mu = static_cast<FixedWeight>(random_int(random, 0, 32767)),
           .beside = at(weights[0]),
           .above = at(weights[1]),
           .below = at(weights[2]),
           .prior = prior,
           .columns = columns};
  }

  /// The row's starts are those of a neighbour, too.
  void share_starts(WindowRow& neighbour) const { neighbour.start = row.centre.start; }
};

WindowPrior random_prior(std::mt19937& random) {
  WindowPrior prior;
  prior.radius = random_int(random, 0, kMaxWindowPriorRadius);
  for (auto& rise : prior.rises) {
    rise = static_cast<std::uint16_t>(random_int(random, 0, 700));
  }
  prior.ceiling = static_cast<std::uint16_t>(random_int(random, 0, 1020));
  if (random() % 3 == 0) {
    prior.lanes = 0xFFFFFF;  // three candidates
  }
  return prior;
}

VANTAGE_ON_EVERY_TARGET(WindowStep);

using Rows = std::array<std::vector<WindowCells>, kWindows>;

Rows stepped(void (*kernel)(const WindowStepRow&, const std::array<WindowCells*, kWindows>&),
             const WindowStepRow& row) {
  Rows rows;
  for (auto& cells : rows) {
    cells.assign(row.columns + kWindowMargin, 77);
  }
  kernel(row, {rows[0].data(), rows[1].data()});
  return rows;
}

TEST_P(WindowStep, EqualsReference) {
  std::mt19937 random(7);
  for (int columns = 1; columns <= 40; ++columns) {
    for (const int seconds : {0, 1, 5, 20}) {
      const int max = random() % 2 == 0 ? 255 : 40;
      StepCase step(random, columns, seconds, max, random_prior(random));
      EXPECT_EQ(stepped(window_step_row, step.row), stepped(window_step_row_ref, step.row));
      step.share_starts(columns % 2 == 0 ? step.row.up : step.row.down);
      EXPECT_EQ(stepped(window_step_row, step.row), stepped(window_step_row_ref, step.row));
    }
  }
}

struct Winners {
  std::vector<std::uint8_t> window, lane;
  std::vector<std::uint16_t> total, before, after;
  std::vector<WindowCells> support;
};

Winners winners_of(void (*kernel)(const WindowStepRow&, const WindowWinners&), const StepCase& step,
                   bool all) {
  const auto size = static_cast<std::size_t>(step.row.columns + kWindowMargin);
  Winners result{std::vector<std::uint8_t>(size),  std::vector<std::uint8_t>(size),
                 std::vector<std::uint16_t>(size), std::vector<std::uint16_t>(size),
                 std::vector<std::uint16_t>(size), std::vector<WindowCells>(size)};
  WindowWinners winners{.window = result.window.data(),
                        .lane = result.lane.data(),
                        .total = result.total.data(),
                        .total_before = result.before.data(),
                        .total_after = result.after.data(),
                        .support = result.support.data()};
  if (!all) {
    winners.selectable = {step.selectable[0].data() + StepCase::kBefore,
                          step.selectable[1].data() + StepCase::kBefore};
  }
  kernel(step.row, winners);
  const auto columns = static_cast<std::size_t>(step.row.columns);
  result.window.resize(columns);
  result.lane.resize(columns);
  result.total.resize(columns);
  result.before.resize(columns);
  result.after.resize(columns);
  result.support.resize(columns);
  return result;
}

TEST_P(WindowStep, WinnersEqualReference) {
  std::mt19937 random(8);
  for (int columns = 1; columns <= 40; ++columns) {
    for (const int seconds : {0, 1, 5}) {
      // Small numbers make ties.
      const int max = columns % 2 == 0 ? 255 : 1;
      const StepCase step(random, columns, seconds, max, random_prior(random));
      for (const bool all : {true, false}) {
        const Winners winners = winners_of(window_winners_row, step, all);
        const Winners expected = winners_of(window_winners_row_ref, step, all);
        EXPECT_EQ(winners.window, expected.window);
        EXPECT_EQ(winners.lane, expected.lane);
        EXPECT_EQ(winners.total, expected.total);
        EXPECT_EQ(winners.before, expected.before);
        EXPECT_EQ(winners.after, expected.after);
        EXPECT_EQ(winners.support, expected.support);
      }
    }
  }
}

/// By hand: two neighbours whose windows begin three candidates apart.
TEST_P(WindowStep, MovesSupportToTheLanesOfEqualCandidates) {
  std::mt19937 random(9);
  WindowPrior prior;
  prior.ceiling = 1020;
  StepCase step(random, 1, 0, 0, prior);
  const auto x = StepCase::kBefore;
  for (auto& of_weights : step.weights) {
    std::fill(of_weights.begin(), of_weights.end(), FixedWeight{0x4000});  // ½
  }
  step.row.mu = 0;
  step.rows[0].start[0][x] = 7;
  step.rows[1].start[0][x] = 10;
  step.rows[0].support[0][x] = WindowCells{100} << (8 * 5);  // candidate 12
  const Winners winners = winners_of(window_winners_row, step, true);
  EXPECT_EQ(winners.lane.front(), 2);
  EXPECT_EQ(winners.total.front(), 100 * kWindowTotalUnits / 2);
}

TEST_P(WindowStep, DisparitiesEqualReference) {
  std::mt19937 random(10);
  for (int columns = 1; columns <= 40; ++columns) {
    const StepCase step(random, columns, 3, columns % 2 == 0 ? 255 : 1, random_prior(random));
    Winners of_step = winners_of(window_winners_row_ref, step, false);
    const WindowWinners winners{.window = of_step.window.data(),
                                .lane = of_step.lane.data(),
                                .total = of_step.total.data(),
                                .total_before = of_step.before.data(),
                                .total_after = of_step.after.data()};
    const WindowDisparities row{.winners = &winners,
                                .start = step.row.centre.start,
                                .disparity_min = -7,
                                .candidates = random_int(random, 1, kWindowCandidates),
                                .is_refined = columns % 5 != 0,
                                .columns = columns};
    GuardedRow<float> disparity_px(columns, 3, -77);
    GuardedRow<float> expected(columns, 3, -77);
    window_disparity_row(row, disparity_px.data());
    window_disparity_row_ref(row, 0, columns, expected.data());
    EXPECT_TRUE(disparity_px.intact());
    for (std::size_t x = 0; x < static_cast<std::size_t>(columns); ++x) {
      const float value = disparity_px.values()[x];
      EXPECT_TRUE(std::isnan(value) ? std::isnan(expected.values()[x])
                                    : value == expected.values()[x])
          << x;
    }
  }
}

}  // namespace vantage::kernels::window_step_test
