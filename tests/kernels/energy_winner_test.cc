#include "kernels/energy_winner/energy_winner.h"

#include "engine/image/image.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels::energy_winner_test {

VANTAGE_ON_EVERY_TARGET(EnergyWinner);

constexpr std::int32_t kSentinel = -0x5A5A5A5B;
constexpr FixedEnergy kEnergySentinel = -77;
constexpr float kFloatSentinel = -12345.5F;

/// What the energies of a row are like.
enum class EnergyKind {
  kConstant,
  kFewLevels,   ///< many ties
  kWide,        ///< all that there are
  kMostOrLess,  ///< most of them kMaxEnergy
  kMostOfThem,  ///< all of them kMaxEnergy
};
constexpr EnergyKind kKinds[] = {EnergyKind::kConstant, EnergyKind::kFewLevels, EnergyKind::kWide,
                                 EnergyKind::kMostOrLess, EnergyKind::kMostOfThem};

FixedEnergy random_energy(std::mt19937& random, EnergyKind kind) {
  switch (kind) {
    case EnergyKind::kConstant:
      return 725;
    case EnergyKind::kFewLevels:
      return static_cast<FixedEnergy>(random_int(random, 3, 6));
    case EnergyKind::kWide:
      return static_cast<FixedEnergy>(random_int(random, 0, kMaxEnergy));
    case EnergyKind::kMostOrLess:
      return static_cast<FixedEnergy>(kMaxEnergy - (random() % 20 == 0 ? random() % 3 : 0));
    case EnergyKind::kMostOfThem:
      break;
  }
  return kMaxEnergy;
}

/// Random energies of a row. Candidates without partners would win if anyone looked at them, and so
/// would what lies between columns.
struct EnergyCells {
  int pitch;
  Image<FixedEnergy> cells;

  EnergyCells(std::mt19937& random, const WinnerCase& c, EnergyKind kind)
      : pitch(c.lanes() + random_int(random, 0, 2) * kLaneMultiple), cells(pitch * c.width, 1) {
    for (int x = 0; x < c.width; ++x) {
      for (int i = 0; i < pitch; ++i) {
        const bool is_lane_only = i >= c.count && i < c.lanes();
        at(x, i) = c.counts(x, i) ? random_energy(random, kind)
                   : is_lane_only ? kMaxEnergy
                                  : static_cast<FixedEnergy>(random_int(random, 0, 3));
      }
    }
  }
  [[nodiscard]] FixedEnergy& at(int x, int i) { return cells.row(0)[x * pitch + i]; }
  [[nodiscard]] FixedEnergy at(int x, int i) const { return cells.row(0)[x * pitch + i]; }
  /// Columns [begin, end).
  [[nodiscard]] EnergyRow row(const WinnerCase& c, int begin, int end) const {
    EnergyRow row;
    row.cells = cells.row(0) + static_cast<std::ptrdiff_t>(begin) * pitch;
    row.pitch = pitch;
    row.geometry = {c.width, c.disparity_min, c.count, c.direction, c.steps_per_px};
    row.first_column = begin;
    row.columns = end - begin;
    return row;
  }
};

/// One column: the definitions, one after the other.
struct Column {
  std::int32_t winner = kNoWinner;
  FixedEnergy min = kMaxEnergy;
  /// By the parabola, in double.
  double disparity_px = 0;

  Column(const WinnerCase& c, const EnergyCells& cells, int x) {
    for (int i = 0; i < c.count; ++i) {
      if (c.counts(x, i) && (winner == kNoWinner || cells.at(x, i) < min)) {
        winner = i;
        min = cells.at(x, i);
      }
    }
    disparity_px = c.disparity_min + winner;
    if (c.counts(x, winner - 1) && c.counts(x, winner + 1)) {
      const double before = cells.at(x, winner - 1);
      const double after = cells.at(x, winner + 1);
      const double curvature = before - 2.0 * min + after;
      disparity_px += curvature > 0 ? (before - after) / (2 * curvature) : 0;
    }
  }
};

/// Calls body(random, case, cells, begin, end) for every kind of energies in every geometry of a
/// small world, in wide rows and with many candidates: the whole row and a part of it.
template <typename Body>
void for_each_row(const Body& body) {
  std::mt19937 random(61);
  const auto visit = [&](const WinnerCase& c, EnergyKind kind) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const EnergyCells cells(random, c, kind);
    const int begin = random_int(random, 0, c.width - 1);
    body(random, c, cells, 0, c.width);
    body(random, c, cells, begin, random_int(random, begin + 1, c.width));
  };
  for_each_winner_case([&](const WinnerCase& c) {
    if (c.radius == 0 && c.index_bits == 0 && !c.whole_windows_only) {
      visit(c, kKinds[random() % std::size(kKinds)]);
    }
  });
  for (const int count : {1, 3, 16, 17, 33, 48, 64, 113, 128, 300}) {
    for (const int direction : {-1, 1}) {
      for (const EnergyKind kind : kKinds) {
        WinnerCase c;
        c.width = count + 20;
        c.count = count;
        c.disparity_min = random_int(random, -count, 5);
        c.direction = direction;
        visit(c, kind);
      }
    }
  }
}

TEST_P(EnergyWinner, IsTheFirstOfTheLeastWithAPartner) {
  int columns_with_none = 0;
  int columns_with_all = 0;
  for_each_row(
      [&](std::mt19937& random, const WinnerCase& c, const EnergyCells& cells, int begin, int end) {
        const EnergyRow row = cells.row(c, begin, end);
        const auto columns = static_cast<std::size_t>(row.columns);
        GuardedRow<std::int32_t> winners(columns, random() % 5, kSentinel);
        GuardedRow<FixedEnergy> min(columns, random() % 5, kEnergySentinel);
        select_energy_winners_row(row, winners.data(), min.data());
        ASSERT_TRUE(winners.intact() && min.intact()) << c;
        for (std::size_t j = 0; j < columns; ++j) {
          const int x = begin + static_cast<int>(j);
          const Column column(c, cells, x);
          ASSERT_EQ(winners.values()[j], column.winner) << c << ", column " << x;
          ASSERT_EQ(min.values()[j], column.min) << c << ", column " << x;
          columns_with_none += column.winner == kNoWinner ? 1 : 0;
          columns_with_all += c.counts(x, 0) && c.counts(x, c.count - 1) ? 1 : 0;
        }
      });
  EXPECT_GT(columns_with_none, 1000);
  EXPECT_GT(columns_with_all, 1000);
}

TEST_P(EnergyWinner, TiesGoToTheSmallestDisparity) {
  std::mt19937 random(62);
  for (int count = 1; count <= 70; ++count) {
    for (int first = 0; first < count; ++first) {
      WinnerCase c;
      c.width = 80;
      c.count = count;
      EnergyCells cells(random, c, EnergyKind::kConstant);
      // Column 75 has all partners: all candidates from `first` on are equal, those before worse.
      for (int i = 0; i < count; ++i) {
        cells.at(75, i) = i < first ? 51 : 50;
      }
      std::int32_t winner = kSentinel;
      FixedEnergy min = kEnergySentinel;
      select_energy_winners_row(cells.row(c, 75, 76), &winner, &min);
      ASSERT_EQ(winner, first) << count << " candidates";
      ASSERT_EQ(min, 50);
    }
  }
}

TEST_P(EnergyWinner, TheLastOfManyCandidatesMayWin) {
  constexpr int kCount = 32752;
  Image<FixedEnergy> cells(kCount, 1);
  cells.fill(50);
  cells.at(kCount - 1, 0) = 49;
  EnergyRow row;
  row.cells = cells.row(0);
  row.pitch = kCount;
  row.columns = 1;
  // At column 36000 all have a partner, at column 1 of two the last two have.
  for (const bool all : {true, false}) {
    row.geometry =
        all ? CandidateGeometry{40000, 0, kCount, -1} : CandidateGeometry{2, 1 - kCount, kCount, 1};
    row.first_column = all ? 36000 : 1;
    std::int32_t winner = kSentinel;
    FixedEnergy min = kEnergySentinel;
    select_energy_winners_row(row, &winner, &min);
    EXPECT_EQ(winner, kCount - 1) << all;
    EXPECT_EQ(min, 49) << all;
  }
}

TEST(EnergyDisparity, IsThatOfTheParabolaThroughWinnerAndNeighbours) {
  int moved = 0;
  for_each_row(
      [&](std::mt19937& random, const WinnerCase& c, const EnergyCells& cells, int begin, int end) {
        const EnergyRow row = cells.row(c, begin, end);
        const auto columns = static_cast<std::size_t>(row.columns);
        std::vector<std::int32_t> winners(columns);
        std::vector<FixedEnergy> min(columns);
        select_energy_winners_row(row, winners.data(), min.data());
        for (const bool refined : {false, true}) {
          GuardedRow<float> disparity_px(columns, random() % 5, kFloatSentinel);
          energy_disparity_row(row, winners.data(), refined, disparity_px.data());
          ASSERT_TRUE(disparity_px.intact()) << c;
          for (std::size_t j = 0; j < columns; ++j) {
            const int x = begin + static_cast<int>(j);
            const Column column(c, cells, x);
            const float actual_px = disparity_px.values()[j];
            ASSERT_EQ(std::isnan(actual_px), column.winner == kNoWinner) << c << ", column " << x;
            if (column.winner == kNoWinner) {
              continue;
            }
            const double whole_px = c.disparity_min + column.winner;
            if (refined) {
              ASSERT_NEAR(actual_px, column.disparity_px, 1e-6 * (1 + std::abs(whole_px)))
                  << c << ", column " << x;
              ASSERT_LE(std::abs(actual_px - whole_px), 0.5);
              moved += column.disparity_px != whole_px ? 1 : 0;
            } else {
              ASSERT_EQ(actual_px, whole_px) << c << ", column " << x;
            }
          }
        }
      });
  EXPECT_GT(moved, 1000);
}

TEST(EnergyDisparity, OfAParabolaIsItsLowestPoint) {
  std::mt19937 random(64);
  WinnerCase c;
  c.width = 60;
  c.disparity_min = 3;
  c.count = 20;
  EnergyCells cells(random, c, EnergyKind::kConstant);
  for (int i = 0; i < c.count; ++i) {  // 4 (i − 7¼)², less a constant
    cells.at(40, i) = static_cast<FixedEnergy>(4 * i * i - 58 * i + 300);
  }
  const std::int32_t winner = 7;
  float disparity_px = kFloatSentinel;
  energy_disparity_row(cells.row(c, 40, 41), &winner, true, &disparity_px);
  EXPECT_EQ(disparity_px, 10.25F);
}

TEST(EnergyProbability, IsTheShareOfTheWinnersLikelihood) {
  std::mt19937 random(65);
  for (const int lanes : kLaneCounts) {
    for (const float steps_per_nat : {3.0F, 64.0F, 256.0F, 1024.0F}) {
      EnergyColumnsRow row;
      row.columns = random_int(random, 1, 9);
      row.lanes = lanes;
      row.pitch = lanes + random_int(random, 0, 2) * kLaneMultiple;
      Image<FixedEnergy> cells(static_cast<int>(row.pitch) * row.columns, 1);
      cells.fill(0);  // what lies between columns would be as probable as any
      row.cells = cells.row(0);
      std::vector<FixedEnergy> min;
      for (int j = 0; j < row.columns; ++j) {
        FixedEnergy* const column = cells.row(0) + j * row.pitch;
        // From columns of one candidate to those of equal ones.
        const int max = random_int(random, 0, 3) * static_cast<int>(4 * steps_per_nat);
        for (int i = 0; i < lanes; ++i) {
          column[i] =
              random() % 4 == 0 ? kMaxEnergy : static_cast<FixedEnergy>(random_int(random, 0, max));
        }
        column[random() % static_cast<unsigned>(lanes)] = 0;
        // The winner may be another than the least of all, which has no partner.
        min.push_back(
            static_cast<FixedEnergy>(random_int(random, 0, 1) * random_int(random, 0, max)));
      }
      min.back() = row.columns > 1 ? kMaxEnergy : 0;
      const auto probability = row_on_every_target<float>(min.size(), energy_probability_row, row,
                                                          min.data(), steps_per_nat);
      for (int j = 0; j < row.columns; ++j) {
        const auto at = static_cast<std::size_t>(j);
        const float actual = probability[at];
        ASSERT_EQ(std::isnan(actual), min[at] == kMaxEnergy);
        if (min[at] == kMaxEnergy) {
          continue;
        }
        double sum = 0;
        for (int i = 0; i < lanes; ++i) {
          sum += std::exp((min[at] - row.cells[j * row.pitch + i]) / double{steps_per_nat});
        }
        ASSERT_NEAR(actual, 1 / sum, 1e-5 / sum) << lanes << " lanes, " << steps_per_nat;
      }
    }
  }
}

}  // namespace vantage::kernels::energy_winner_test
