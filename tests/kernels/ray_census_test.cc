#include "kernels/ray_census/ray_census.h"

#include <array>

#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::ray_census_test {

VANTAGE_ON_EVERY_TARGET(RayCensus);

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

/// Neighbour by neighbour, of all channels together.
int distance(const RayCensusPairs& row, int column, int lane) {
  int different = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [a, b] = row.channel[c];
    const int at = column * row.partner_step + lane;
    for (std::size_t p = 0; p < 3; ++p) {
      for (int bit = 0; bit < 8; ++bit) {
        int of_a = (a[p][column] >> bit) & 1;
        int of_b = (b[p][at] >> bit) & 1;
        if (row.thresholds == 3) {
          of_a = 2 * of_a + ((a[3 + p][column] >> bit) & 1);
          of_b = 2 * of_b + ((b[3 + p][at] >> bit) & 1);
        }
        different += of_a > of_b ? of_a - of_b : of_b - of_a;
      }
    }
  }
  return different;
}

/// Calls check(row, column, lane, the cell) for rows of every shape, with one threshold and three.
template <typename Run, typename Check>
void for_each_cell(const Run& run, const Check& check) {
  for_each_feature_rows<std::uint8_t, kMaxRayCensusBytes>(draw, [&](const auto& pairs) {
    for (const int thresholds : {1, 3}) {
      RayCensusPairs row{pairs, thresholds};
      for (auto& channel : row.channel) {  // bytes that are not there are not read
        for (std::size_t p = thresholds == 1 ? 3 : 6; p < kMaxRayCensusBytes; ++p) {
          channel.reference[p] = nullptr;
          channel.partner[p] = nullptr;
        }
      }
      const auto cells = run(row);
      for (int j = 0; j < row.columns; ++j) {
        for (int i = 0; i < row.lanes; ++i) {
          check(row, j, i, cells[j * row.lanes + i]);
        }
      }
    }
  });
}

/// Every byte of a float differs from entry to entry.
std::array<float, kMaxRayCensusDistances> likelihoods() {
  std::array<float, kMaxRayCensusDistances> values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = std::exp(-0.37F * static_cast<float>(k)) / 3;
  }
  return values;
}

TEST_P(RayCensus, HammingDistance) {
  for_each_cell(
      [](const RayCensusPairs& row) {
        return written_row(cell_count(row), -99.0F, ray_hamming_row, row);
      },
      [](const RayCensusPairs& row, int j, int i, float cell) {
        ASSERT_FLOAT_EQ(cell, static_cast<float>(distance(row, j, i)) /
                                  static_cast<float>(row.channels * row.thresholds));
      });
}

TEST_P(RayCensus, LikelihoodsAreTheTables) {
  const auto values = likelihoods();
  const LikelihoodByDistance table(values);
  for (int k = 0; k < kMaxRayCensusDistances; ++k) {
    ASSERT_EQ(table.at(k), values[k]);
  }
  for_each_cell(
      [&](RayCensusPairs row) {
        row.channels = 1;
        return written_row(cell_count(row), -99.0F, ray_census_likelihood_row, row, table);
      },
      [&](RayCensusPairs row, int j, int i, float cell) {
        row.channels = 1;
        ASSERT_EQ(cell, i < row.count ? values[distance(row, j, i)] : 0.0F);
      });
}

/// Entries that differ up to the last one, which the rest repeats.
ByteByDistance energies_up_to(int last) {
  ByteByDistance table;
  table.last = last;
  for (int k = 0; k < kMaxRayCensusDistances; ++k) {
    table.steps[k] = static_cast<std::uint8_t>(251 - 3 * std::min(k, last));
  }
  return table;
}

void expect_energies_of(const ByteByDistance& table) {
  for_each_cell(
      [&](RayCensusPairs row) {
        row.channels = 1;
        return written_row(cell_count(row), std::uint8_t{0xCD}, ray_census_energy_row, row, table);
      },
      [&](RayCensusPairs row, int j, int i, std::uint8_t cell) {
        row.channels = 1;
        ASSERT_EQ(int{cell}, i < row.count ? table.steps[distance(row, j, i)] : 255);
      });
}

TEST_P(RayCensus, EnergiesAreTheTables) {
  // Shorter tables are looked up in fewer parts.
  for (const int last : {0, 15, 16, 47, 48, kMaxRayCensusDistances - 1}) {
    SCOPED_TRACE(last);
    expect_energies_of(energies_up_to(last));
  }
}

}  // namespace vantage::kernels::ray_census_test
