#include "kernels/small_census/small_census.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {
namespace {

class SmallCensus : public EveryTarget {};
VANTAGE_ON_EVERY_TARGET(SmallCensus);

std::uint8_t draw(std::mt19937& random) {
  switch (random() % 6) {
    case 0:
      return 0;
    case 1:
      return 0xFF;
    default:
      return static_cast<std::uint8_t>(random());
  }
}

/// Bit by bit, of all channels together.
int distance(const SmallCensusPairs& row, int column, int lane) {
  int different = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [a, b] = row.channel[static_cast<std::size_t>(c)];
    for (std::size_t p = 0; p < kSmallCensusBytes; ++p) {
      for (int bit = 0; bit < 8; ++bit) {
        different +=
            ((a[p][column] >> bit) & 1) ^ ((b[p][column * row.partner_step + lane] >> bit) & 1);
      }
    }
  }
  return different;
}

/// Calls check(row, column, lane, index of the cell) for rows of every shape.
template <typename Run, typename Check>
void for_each_cell(const Run& run, const Check& check) {
  for_each_feature_rows<std::uint8_t, kSmallCensusBytes>(draw, [&](const SmallCensusPairs& row) {
    const auto cells = run(row);
    for (int j = 0; j < row.columns; ++j) {
      for (int i = 0; i < row.lanes; ++i) {
        check(row, j, i, cells[static_cast<std::size_t>(j * row.lanes + i)]);
      }
    }
  });
}

/// Every byte of a float differs from entry to entry.
std::array<float, kSmallCensusDistances> likelihoods() {
  std::array<float, kSmallCensusDistances> values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = std::exp(-0.37F * static_cast<float>(k)) / 3;
  }
  return values;
}

TEST_P(SmallCensus, HammingDistance) {
  for_each_cell(
      [](const SmallCensusPairs& row) {
        return equal_cells(
            cell_count(row), [&](float* out) { small_hamming_row(row, out); },
            [&](float* out) { small_hamming_row_ref(row, out); });
      },
      [](const SmallCensusPairs& row, int j, int i, float cell) {
        ASSERT_FLOAT_EQ(cell,
                        static_cast<float>(distance(row, j, i)) / static_cast<float>(row.channels));
      });
}

TEST_P(SmallCensus, LikelihoodsAreTheTables) {
  const auto values = likelihoods();
  const LikelihoodByDistance table(values);
  for (int k = 0; k < kSmallCensusDistances; ++k) {
    ASSERT_EQ(table.at(k), values[static_cast<std::size_t>(k)]);
  }
  for_each_cell(
      [&](SmallCensusPairs row) {
        row.channels = 1;
        return equal_cells(
            cell_count(row), [&](float* out) { small_census_likelihood_row(row, table, out); },
            [&](float* out) { small_census_likelihood_row_ref(row, table, out); });
      },
      [&](SmallCensusPairs row, int j, int i, float cell) {
        row.channels = 1;
        ASSERT_EQ(cell,
                  i < row.count ? values[static_cast<std::size_t>(distance(row, j, i))] : 0.0F);
      });
}

TEST_P(SmallCensus, EnergiesAreTheTables) {
  EnergyByDistance table;
  for (std::size_t k = 0; k < kSmallCensusDistances; ++k) {
    table.steps[k] = static_cast<std::uint8_t>(251 - 10 * k);
  }
  for_each_cell(
      [&](SmallCensusPairs row) {
        row.channels = 1;
        GuardedRow<std::uint8_t> cells(cell_count(row), 3, 0xCD);
        GuardedRow<std::uint8_t> expected(cell_count(row), 0, 0xCD);
        small_census_energy_row(row, table, cells.data());
        small_census_energy_row_ref(row, table, expected.data());
        EXPECT_TRUE(cells.intact());
        EXPECT_EQ(cells.values(), expected.values());
        return cells.values();
      },
      [&](SmallCensusPairs row, int j, int i, std::uint8_t cell) {
        row.channels = 1;
        ASSERT_EQ(int{cell},
                  i < row.count ? table.steps[static_cast<std::size_t>(distance(row, j, i))] : 255);
      });
}

}  // namespace
}  // namespace vantage::kernels
