#include "kernels/winner/winner.h"

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels::winner_test {

constexpr std::int32_t kSentinel = -0x5A5A5A5B;

/// §1: the least mean, compared as a fraction; the smallest disparity of equals.
std::int32_t brute_force_winner(const WinnerCase& c, const WinnerCells& cells, int x) {
  std::int32_t best = kNoWinner;
  for (int i = 0; i < c.count; ++i) {
    if (!c.counts(x, i)) {
      continue;
    }
    if (best == kNoWinner ||
        cells.sum(x, i) * c.samples(x, best) < cells.sum(x, best) * c.samples(x, i)) {
      best = i;
    }
  }
  return best;
}

/// The whole row and a part of it, as strips cut it.
void expect_winners(std::mt19937& random, const WinnerCase& c, const WinnerCells& cells) {
  std::vector<std::int32_t> expected;
  for (int x = 0; x < c.width; ++x) {
    expected.push_back(brute_force_winner(c, cells, x));
  }
  const int begin = random_int(random, 0, c.width - 1);
  const int end = random_int(random, begin + 1, c.width);
  for (const auto& [first, last] : {std::pair{0, c.width}, std::pair{begin, end}}) {
    WinnerRow row = c.row();
    row.cells = cells.cells.data() + cells.index(first, 0);
    row.first_column = first;
    row.columns = last - first;
    GuardedRow<std::int32_t> winners(row.columns, random() % 5, kSentinel);
    select_winners_row(row, winners.data());
    const std::vector<std::int32_t> wanted(expected.begin() + first, expected.begin() + last);
    ASSERT_EQ(winners.values(), wanted) << c << ", columns " << first << " to " << last;
    ASSERT_TRUE(winners.intact()) << c;
  }
}

VANTAGE_ON_EVERY_TARGET(Winner);

TEST_P(Winner, IsTheLeastMeanOverSamplesInsideBothImages) {
  std::mt19937 random(32);
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const std::int32_t max[] = {0, 1, 3, 20, largest_sum(c)};
    expect_winners(random, c, WinnerCells(random, c, max[random() % std::size(max)]));
  });
}

TEST_P(Winner, TiesGoToTheSmallestDisparity) {
  for (int count = 1; count <= 70; ++count) {
    for (int first = 0; first < count; ++first) {
      for (const int bits : {0, enough_index_bits(count)}) {
        WinnerCase c;
        c.width = 80;
        c.count = count;
        c.index_bits = bits;
        std::mt19937 random(33);
        WinnerCells cells(random, c, 0);
        // Column 75 has all partners: all candidates from `first` on are equal, those before worse.
        for (int i = 0; i < count; ++i) {
          cells.cells[cells.index(75, i)] = (i < first ? 9 : 7) * (1 << bits) + (bits > 0 ? i : 0);
        }
        WinnerRow row = c.row();
        row.cells = cells.cells.data() + cells.index(75, 0);
        row.first_column = 75;
        row.columns = 1;
        std::int32_t winner = kNoWinner;
        select_winners_row(row, &winner);
        ASSERT_EQ(winner, first) << count << " candidates, " << bits << " bits";
      }
    }
  }
}

TEST(WinnerRowHelpers, AgreeWithTheDefinition) {
  for_each_winner_case([](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const WinnerRow row = c.row();
    const CandidateRange plain = row.plain_columns();
    for (int x = 0; x < c.width; ++x) {
      const CandidateRange candidates = row.candidates(x);
      const CandidateRange full = row.full_window_candidates(x);
      bool all_full = true;
      for (int i = 0; i < c.count; ++i) {
        const bool is_candidate = i >= candidates.begin && i < candidates.end;
        ASSERT_EQ(is_candidate, c.counts(x, i)) << c << ", column " << x << ", candidate " << i;
        const bool is_full = i >= full.begin && i < full.end;
        ASSERT_EQ(is_full, c.counts(x, i) && c.is_full(x, i)) << c << ", column " << x;
        all_full = all_full && is_full;
        if (is_candidate) {
          ASSERT_EQ(row.window_columns(x, i), c.samples(x, i)) << c << ", column " << x;
        }
        if (is_full) {
          ASSERT_EQ(row.full_window_columns(x), c.samples(x, i)) << c << ", column " << x;
        }
      }
      ASSERT_EQ(x >= plain.begin && x < plain.end, all_full) << c << ", column " << x;
    }
  });
}

TEST(CandidateGeometry, AgreesWithTheDefinition) {
  for_each_winner_case([](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const CandidateGeometry geometry{c.width, c.disparity_min, c.count, c.direction,
                                     c.steps_per_px};
    ASSERT_EQ(geometry.lanes(), c.lanes());
    const CandidateRange all = geometry.columns_with_all_partners(c.radius);
    for (int x = 0; x < c.width; ++x) {
      const CandidateRange inside = geometry.with_partner(x, c.radius);
      const int last = std::min(x + c.radius, c.width - 1);
      const CandidateRange stretch = geometry.with_partners(x, last);
      bool all_inside = true;
      for (int i = 0; i < c.count; ++i) {
        const double partner = c.partner(x, i);
        ASSERT_EQ(geometry.partner(x, i), c.steps_per_px * partner);
        ASSERT_EQ(i >= inside.begin && i < inside.end,
                  partner >= c.radius && partner <= c.width - 1 - c.radius)
            << c << ", column " << x << ", candidate " << i;
        ASSERT_EQ(i >= stretch.begin && i < stretch.end,
                  c.has_partner(x, i) && c.has_partner(last, i))
            << c << ", columns " << x << " to " << last << ", candidate " << i;
        all_inside = all_inside && c.is_full(x, i);
      }
      ASSERT_EQ(x >= all.begin && x < all.end, all_inside) << c << ", column " << x;
    }
  });
}

}  // namespace vantage::kernels::winner_test
