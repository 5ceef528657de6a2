#include "kernels/mean_energy/mean_energy.h"

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels::mean_energy_test {

TEST(MeanEnergy, IsTheMeanOverSamplesInsideBothImages) {
  std::mt19937 random(61);
  const EnergyUnit units[] = {{1, 1, 0}, {3, 0.5, 0}, {7, 1.0 / 3, 11.5}, {181, 64, -2}};
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const WinnerCells cells(random, c, random() % 2 == 0 ? 20 : largest_sum(c));
    const EnergyUnit& unit = units[random() % std::size(units)];
    WinnerRow row = c.row();
    row.first_column = random_int(random, 0, c.width - 1);
    row.columns = random_int(random, 1, c.width - row.first_column);
    row.cells = cells.cells.data() + cells.index(row.first_column, 0);
    const auto values = row_on_every_target<float>(
        static_cast<std::size_t>(row.columns) * static_cast<std::size_t>(cells.lanes),
        mean_energy_row, row, unit);
    for (int j = 0; j < row.columns; ++j) {
      const int x = row.first_column + j;
      for (int i = 0; i < cells.lanes; ++i) {
        const float actual = values[cells.index(j, i)];
        if (!c.counts(x, i)) {
          ASSERT_EQ(actual, 0) << c << ", column " << x << ", lane " << i;
          continue;
        }
        const double mean =
            static_cast<double>(cells.sum(x, i)) / (unit.window_rows * c.samples(x, i));
        const double expected = mean * unit.scale - unit.offset;
        ASSERT_NEAR(actual, expected, 1e-7 * std::abs(expected) + 1e-12 * mean * unit.scale)
            << c << ", column " << x << ", candidate " << i;
      }
    }
  });
}

VANTAGE_ON_EVERY_TARGET(MeanEnergy);

TEST_P(MeanEnergy, IsThatOfAWinnerAlone) {
  std::mt19937 random(62);
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const EnergyUnit unit{5, 0.37, 1.25};
    const WinnerCells cells(random, c, 1000);
    WinnerRow row = c.row();
    row.cells = cells.cells.data();
    std::vector<float> expected(cells.sums.size());
    mean_energy_row(row, unit, expected.data());
    std::vector<std::int32_t> winners(c.width);
    select_winners_row(row, winners.data());
    std::vector<float> alone(winners.size());
    winner_energy_row(row, unit, winners.data(), alone.data());
    for (int x = 0; x < c.width; ++x) {
      const auto j = static_cast<std::size_t>(x);
      if (winners[j] == kNoWinner) {
        ASSERT_TRUE(std::isnan(alone[j])) << c;
      } else {
        ASSERT_EQ(alone[j], expected[cells.index(x, winners[j])]) << c;
      }
    }
  });
}

}  // namespace vantage::kernels::mean_energy_test
