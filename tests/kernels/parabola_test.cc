#include "kernels/parabola/parabola.h"

#include "tests/kernels/cell_winner_rows.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels::parabola_test {

constexpr float kSentinel = -12345.5F;

/// Mean energies of a candidate and its neighbours times a common denominator, so that no rounding
/// decides whether there is a curvature.
struct Energies {
  std::int64_t below;
  std::int64_t at;
  std::int64_t above;

  Energies(const WinnerCase& c, const WinnerCells& cells, int x, int i) {
    const std::int64_t samples[] = {c.samples(x, i - 1), c.samples(x, i), c.samples(x, i + 1)};
    below = cells.sum(x, i - 1) * samples[1] * samples[2];
    at = cells.sum(x, i) * samples[0] * samples[2];
    above = cells.sum(x, i + 1) * samples[0] * samples[1];
  }
  [[nodiscard]] std::int64_t curvature() const { return below - 2 * at + above; }
};

bool has_neighbours(const WinnerCase& c, int x, int i) {
  return c.counts(x, i - 1) && c.counts(x, i + 1);
}

/// EQUATIONS §3.
double refined_disparity(const WinnerCase& c, const WinnerCells& cells, int x, int winner) {
  const double disparity_px = c.disparity_min + winner;
  if (!has_neighbours(c, x, winner)) {
    return disparity_px;
  }
  const Energies energies(c, cells, x, winner);
  return energies.curvature() <= 0
             ? disparity_px
             : disparity_px + static_cast<double>(energies.below - energies.above) /
                                  (2 * static_cast<double>(energies.curvature()));
}

/// For each column the winner, if any, or another candidate, where energies may be bent down. (Not
/// where they are flat: there the rounding of means decides. A winner's never are.)
std::vector<std::int32_t> draw_winners(std::mt19937& random, const WinnerCase& c,
                                       const WinnerCells& cells, const WinnerRow& row) {
  std::vector<std::int32_t> winners(c.width);
  select_winners_row(row, winners.data());
  for (int x = 0; x < c.width; ++x) {
    const int any = random_int(random, 0, c.count - 1);
    if (random() % 2 == 0 && c.counts(x, any) &&
        (!has_neighbours(c, x, any) || Energies(c, cells, x, any).curvature() != 0)) {
      winners[x] = any;
    }
  }
  return winners;
}

using SumKernel = void (*)(const WinnerRow&, const std::int32_t*, float*);

void sweep(SumKernel kernel) {
  std::mt19937 random(41);
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure()) {
      return;
    }
    const std::int32_t max[] = {3, 20, 100000};
    const WinnerCells cells(random, c, std::min(max[random() % std::size(max)], largest_sum(c)));
    WinnerRow row = c.row();
    row.cells = cells.cells.data();
    const std::vector<std::int32_t> winners = draw_winners(random, c, cells, row);
    GuardedRow<float> disparity_px(winners.size(), 1, kSentinel);
    kernel(row, winners.data(), disparity_px.data());
    GuardedRow<float> integer_px(winners.size(), 1, kSentinel);
    integer_disparity_row(row, winners.data(), integer_px.data());
    ASSERT_TRUE(disparity_px.intact() && integer_px.intact()) << c;
    for (int x = 0; x < c.width; ++x) {
      const auto j = static_cast<std::size_t>(x);
      const float value = disparity_px.values()[j];
      if (winners[j] == kNoWinner) {
        ASSERT_TRUE(std::isnan(value)) << c << ", column " << x;
        ASSERT_TRUE(std::isnan(integer_px.values()[j])) << c << ", column " << x;
        continue;
      }
      ASSERT_EQ(integer_px.values()[j], static_cast<float>(c.disparity_min + winners[j]));
      const double expected = refined_disparity(c, cells, x, winners[j]);
      ASSERT_NEAR(value, expected, 1e-6 * (1 + std::abs(expected))) << c << ", column " << x;
    }
  });
}

TEST(ParabolaReference, MovesToTheLowestPointOfMeanEnergies) {
  sweep(SumKernel{parabola_disparity_row_ref});
}

/// EQUATIONS §3 of float cells.
double refined_disparity(const WinnerCase& c, const FloatCells& cells, int x, int winner,
                         bool probabilities) {
  const double disparity_px = c.disparity_min + winner;
  if (!has_neighbours(c, x, winner)) {
    return disparity_px;
  }
  double energies[3];
  for (int n = 0; n < 3; ++n) {
    const double cell = cells.at(x, winner + n - 1);
    if (probabilities && cell == 0) {
      return disparity_px;
    }
    energies[n] = probabilities ? -std::log(cell) : cell;
  }
  const double curvature = energies[0] - 2 * energies[1] + energies[2];
  return curvature <= 0 ? disparity_px
                        : disparity_px + (energies[0] - energies[2]) / (2 * curvature);
}

using CellKernel = void (*)(const CellRow&, const std::int32_t*, float*);

void sweep(CellKernel kernel) {
  std::mt19937 random(42);
  for_each_winner_case([&](const WinnerCase& c) {
    if (testing::Test::HasFatalFailure() || !is_cell_case(c)) {
      return;
    }
    const bool probabilities = random() % 2 == 0;
    const FloatCells cells(
        random, c,
        probabilities ? CellKind::kProbability : kEnergyKinds[random() % std::size(kEnergyKinds)]);
    const int begin = random_int(random, 0, c.width - 1);
    const CellRow row = cells.row(c, begin, random_int(random, begin + 1, c.width), probabilities);
    std::vector<std::int32_t> winners(row.columns);
    select_cell_winners_row(row, {winners.data(), nullptr, nullptr});
    GuardedRow<float> disparity_px(winners.size(), random() % 5, kSentinel);
    kernel(row, winners.data(), disparity_px.data());
    GuardedRow<float> integer_px(winners.size(), random() % 5, kSentinel);
    integer_disparity_row(row, winners.data(), integer_px.data());
    ASSERT_TRUE(disparity_px.intact() && integer_px.intact()) << c;
    for (std::size_t j = 0; j < winners.size(); ++j) {
      const int x = begin + static_cast<int>(j);
      const float value = disparity_px.values()[j];
      if (winners[j] == kNoWinner) {
        ASSERT_TRUE(std::isnan(value) && std::isnan(integer_px.values()[j])) << c;
        continue;
      }
      ASSERT_EQ(integer_px.values()[j], static_cast<float>(c.disparity_min + winners[j]));
      const double expected = refined_disparity(c, cells, x, winners[j], probabilities);
      ASSERT_NEAR(value, expected, 1e-6 * (1 + std::abs(expected))) << c << ", column " << x;
      ASSERT_LE(std::abs(value - integer_px.values()[j]), 0.5F) << c << ", column " << x;
    }
  });
}

TEST(ParabolaReference, MovesToTheLowestPointOfFloatCells) {
  sweep(CellKernel{parabola_disparity_row_ref});
}

VANTAGE_ON_EVERY_TARGET(Parabola);

TEST_P(Parabola, MovesToTheLowestPointOfMeanEnergies) { sweep(SumKernel{parabola_disparity_row}); }
TEST_P(Parabola, MovesToTheLowestPointOfFloatCells) { sweep(CellKernel{parabola_disparity_row}); }

TEST(ParabolaOfProbabilities, IsTheSameOnEveryInstructionSet) {
  std::mt19937 random(43);
  WinnerCase c;
  c.width = 500;
  c.count = 20;
  const FloatCells cells(random, c, CellKind::kProbability);
  const CellRow row = cells.row(c, 0, c.width, true);
  std::vector<std::int32_t> winners(c.width);
  select_cell_winners_row(row, {winners.data(), nullptr, nullptr});
  std::vector<float> first;
  for (const long long target : each_target()) {
    force_target(target);
    std::vector<float> disparity_px(winners.size());
    parabola_disparity_row(row, winners.data(), disparity_px.data());
    if (first.empty()) {
      first = disparity_px;
    }
    EXPECT_EQ(disparity_px, first) << target_name(target);
  }
  force_target(0);
}

/// A row whose only column with three candidates holds `below`, `at`, `above`.
float refine(std::int32_t below, std::int32_t at, std::int32_t above, int disparity_min = 2) {
  WinnerCase c;
  c.width = 40;
  c.count = 3;
  c.disparity_min = disparity_min;
  std::vector<std::int32_t> cells(16, std::numeric_limits<std::int32_t>::min());
  cells[0] = below;
  cells[1] = at;
  cells[2] = above;
  WinnerRow row = c.row();
  row.cells = cells.data();
  row.first_column = 20;
  row.columns = 1;
  const std::int32_t winner = 1;
  float disparity_px = kSentinel;
  parabola_disparity_row(row, &winner, &disparity_px);
  return disparity_px;
}

TEST_P(Parabola, FindsTheVertexOfATrueParabola) {
  for (int quarter = -2; quarter <= 2; ++quarter) {
    // 16·(d − v)² at d = −1, 0, 1 for the vertex v = quarter / 4.
    const auto energy = [&](int d) { return (4 * d - quarter) * (4 * d - quarter); };
    EXPECT_EQ(refine(energy(-1), energy(0), energy(1)), 3.0F + static_cast<float>(quarter) / 4);
    EXPECT_EQ(refine(energy(-1), energy(0), energy(1), -9),
              -8.0F + static_cast<float>(quarter) / 4);
  }
}

TEST_P(Parabola, StaysWhereTheCurvatureIsNotPositive) {
  EXPECT_EQ(refine(5, 5, 5), 3.0F);
  EXPECT_EQ(refine(4, 5, 6), 3.0F);
  EXPECT_EQ(refine(1, 9, 2), 3.0F);
}

TEST_P(Parabola, MovesHalfAPixelAtMostAtAMinimum) {
  constexpr std::int32_t max = std::numeric_limits<std::int32_t>::max() - 1;
  EXPECT_EQ(refine(0, 0, 1), 2.5F);
  EXPECT_EQ(refine(7, 0, 0), 3.5F);
  EXPECT_EQ(refine(0, 0, max), 2.5F);
  EXPECT_EQ(refine(max, 0, max), 3.0F);
}

}  // namespace vantage::kernels::parabola_test
