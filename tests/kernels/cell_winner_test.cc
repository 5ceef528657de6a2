#include "kernels/cell_winner/cell_winner.h"

#include "tests/kernels/cell_winner_rows.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels::cell_winner_test {

constexpr std::int32_t kSentinel = -0x5A5A5A5B;
constexpr float kFloatSentinel = -12345.5F;

/// One column in double: the definitions, one after the other.
struct Column {
  std::int32_t winner = kNoWinner;
  double best = 0;
  std::vector<double> sorted;
  double sum = 0;

  Column(const WinnerCase& c, const FloatCells& cells, int x, bool probabilities) {
    for (int i = 0; i < c.count; ++i) {
      if (!c.counts(x, i)) {
        continue;
      }
      const double value = cells.at(x, i);
      if (winner == kNoWinner || (probabilities ? value > best : value < best)) {
        winner = i;
        best = value;
      }
      sorted.push_back(value);
      sum += value;
    }
    std::sort(sorted.begin(), sorted.end());
  }
  [[nodiscard]] double margin() const {
    return sorted.size() < 2 || sum == 0 ? 0 : (sorted[1] - sorted[0]) / sum;
  }
  [[nodiscard]] double entropy(double scale) const {
    double total = 0;
    for (const double energy : sorted) {
      total += std::exp(-scale * (energy - best));
    }
    double entropy = 0;
    for (const double energy : sorted) {
      const double p = std::exp(-scale * (energy - best)) / total;
      entropy += p > 0 ? p * std::log(p) : 0;
    }
    return entropy;
  }
};

/// Every kind of cells in every geometry, the whole row and a part of it, as strips cut it.
template <typename Body>
void for_each_row(const Body& body) {
  std::mt19937 random(51);
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure() || !is_cell_case(c)) {
      return;
    }
    const bool probabilities = random() % 3 == 0;
    const CellKind kind =
        probabilities ? CellKind::kProbability : kEnergyKinds[random() % std::size(kEnergyKinds)];
    const FloatCells cells(random, c, kind);
    const int begin = random_int(random, 0, c.width - 1);
    body(random, c, cells, 0, c.width, probabilities);
    body(random, c, cells, begin, random_int(random, begin + 1, c.width), probabilities);
  });
}

VANTAGE_ON_EVERY_TARGET(CellWinner);

TEST_P(CellWinner, FollowsTheDefinitions) {
  for_each_row([&](std::mt19937& random, const WinnerCase& c, const FloatCells& cells, int begin,
                   int end, bool probabilities) {
    const CellRow row = cells.row(c, begin, end, probabilities);
    const auto columns = static_cast<std::size_t>(row.columns);
    GuardedRow<std::int32_t> winners(columns, random() % 5, kSentinel);
    GuardedRow<float> best(columns, random() % 5, kFloatSentinel);
    GuardedRow<float> margin(columns, random() % 5, kFloatSentinel);
    const bool with_margin = !probabilities && random() % 2 == 0;
    const bool with_winners = !with_margin || random() % 2 == 0;
    const bool with_best = random() % 2 == 0;
    select_cell_winners_row(
        row, {with_winners ? winners.data() : nullptr, with_best ? best.data() : nullptr,
              with_margin ? margin.data() : nullptr});
    ASSERT_TRUE(winners.intact() && best.intact() && margin.intact()) << c;
    for (std::size_t j = 0; j < columns; ++j) {
      const Column column(c, cells, begin + static_cast<int>(j), probabilities);
      const bool none = column.winner == kNoWinner;
      if (with_winners) {
        ASSERT_EQ(winners.values()[j], column.winner) << c << ", column " << begin << " + " << j;
      }
      if (with_best) {
        const auto expected =
            none ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(column.best);
        ASSERT_TRUE(is_same(best.values()[j], expected)) << c << ", column " << begin << " + " << j;
      }
      if (with_margin) {
        const float actual = margin.values()[j];
        ASSERT_EQ(std::isnan(actual), none) << c;
        if (!none) {
          ASSERT_NEAR(actual, column.margin(), 1e-6 * (1 + std::abs(column.margin()))) << c;
        }
      }
    }
  });
}

TEST_P(CellWinner, EntropyFollowsTheDefinition) {
  for_each_row([&](std::mt19937& random, const WinnerCase& c, const FloatCells& cells, int begin,
                   int end, bool probabilities) {
    if (probabilities) {
      return;
    }
    const CellRow row = cells.row(c, begin, end, false);
    const auto columns = static_cast<std::size_t>(row.columns);
    std::vector<float> best(columns);
    select_cell_winners_row(row, {nullptr, best.data(), nullptr});
    const float scales[] = {0, 1e-5F, 0.02F, 1, 30, 1e36F};
    const float scale = scales[random() % std::size(scales)];
    GuardedRow<float> output(columns, random() % 5, kFloatSentinel);
    cell_entropy_row(row, best.data(), scale, output.data());
    ASSERT_TRUE(output.intact()) << c;
    for (std::size_t j = 0; j < columns; ++j) {
      const Column column(c, cells, begin + static_cast<int>(j), false);
      const float actual = output.values()[j];
      if (column.winner == kNoWinner) {
        ASSERT_TRUE(std::isnan(actual)) << c;
      } else {
        ASSERT_LE(actual, 0) << c;
        ASSERT_NEAR(actual, column.entropy(scale), 1e-5) << c << ", scale " << scale;
      }
    }
  });
}

TEST(CellRowHelpers, PlainColumnsAreThoseWhereEveryCandidateCounts) {
  for_each_winner_case([](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure() || !is_cell_case(c)) {
      return;
    }
    std::mt19937 random(52);
    const CellRow row = FloatCells(random, c, CellKind::kZero).row(c, 0, c.width, false);
    for (int x = 0; x < c.width; ++x) {
      bool all = true;
      for (int i = 0; i < c.count; ++i) {
        const CandidateRange candidates = row.candidates(x);
        ASSERT_EQ(i >= candidates.begin && i < candidates.end, c.counts(x, i)) << c;
        all = all && c.counts(x, i);
      }
      const auto [begin, end] = row.plain_columns();
      ASSERT_EQ(x >= begin && x < end, all) << c << ", column " << x;
    }
  });
}

TEST(CellWinner, MarginsAreTheSameOnEveryInstructionSet) {
  for_each_row([&](std::mt19937& /*random*/, const WinnerCase& c, const FloatCells& cells,
                   int begin, int end, bool probabilities) {
    if (probabilities) {
      return;
    }
    const CellRow row = cells.row(c, begin, end, false);
    row_on_every_target<float>(row.columns, [&](float* out) {
      select_cell_winners_row(row, {nullptr, nullptr, out});
    });
  });
}

TEST(CellEntropy, IsTheSameOnEveryInstructionSet) {
  std::mt19937 random(55);
  WinnerCase c;
  c.width = 300;
  c.count = 70;
  const FloatCells cells(random, c, CellKind::kEnergies);
  const CellRow row = cells.row(c, 0, c.width, false);
  std::vector<float> best(c.width);
  select_cell_winners_row(row, {nullptr, best.data(), nullptr});
  row_on_every_target<float>(best.size(), cell_entropy_row, row, best.data(), 1e-4F);
}

TEST_P(CellWinner, TiesGoToTheSmallestDisparityAndHaveNoMargin) {
  for (int count = 1; count <= 70; ++count) {
    for (int first = 0; first < count; ++first) {
      for (const bool probabilities : {false, true}) {
        WinnerCase c;
        c.width = 80;
        c.count = count;
        std::mt19937 random(53);
        FloatCells cells(random, c, CellKind::kConstant);
        // Column 75 has all partners: all candidates from `first` on are equal, those before worse.
        const float worse = probabilities ? 0.25F : 2.0F;
        for (int i = 0; i < count; ++i) {
          cells.cells[cells.index(75, i)] = i < first ? worse : 0.5F;
        }
        const CellRow row = cells.row(c, 75, 76, probabilities);
        std::int32_t winner = kSentinel;
        float margin = kFloatSentinel;
        select_cell_winners_row(row, {&winner, nullptr, probabilities ? nullptr : &margin});
        ASSERT_EQ(winner, first) << count << " candidates";
        if (!probabilities && first + 1 < count) {
          ASSERT_EQ(margin, 0);
        }
      }
    }
  }
}

TEST(CellWinner, EnergyOfAProbabilityIsItsNegativeLogarithm) {
  std::mt19937 random(54);
  for (int columns = 1; columns <= 70; ++columns) {
    std::vector<float> p(columns);
    for (float& value : p) {
      value = random() % 9 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                : random_cell(random, CellKind::kProbability);
    }
    p[0] = columns % 2 == 0 ? 1.0F : std::numeric_limits<float>::denorm_min();
    const auto energy =
        row_on_every_target<float>(p.size(), probability_energy_row, p.data(), columns);
    for (std::size_t j = 0; j < p.size(); ++j) {
      const float expected = -std::log(p[j]);
      ASSERT_TRUE(is_same(energy[j], expected) ||
                  std::abs(energy[j] - expected) <= 2e-6F * (1 + std::abs(expected)))
          << p[j] << ": " << energy[j];
    }
  }
}

}  // namespace vantage::kernels::cell_winner_test
