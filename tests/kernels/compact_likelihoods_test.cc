#include "kernels/compact_likelihoods/compact_likelihoods.h"

#include <iterator>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::compact_likelihoods_test {

VANTAGE_ON_EVERY_TARGET(CompactLikelihoods);

struct Shape {
  int columns;
  int count;
};
constexpr Shape kShapes[] = {{1, 1}, {2, 3}, {3, 16}, {5, 17}, {7, 40}, {4, 64}, {3, 100}};

int lanes_of(const Shape& shape) { return CandidateGeometry{.count = shape.count}.lanes(); }

/// Likelihoods over many orders of magnitude, 0 in lanes that are no candidates.
std::vector<float> random_likelihoods(const Shape& shape, double min_exponent,
                                      std::mt19937& random) {
  std::vector<float> cells;
  for (int k = 0; k < shape.columns * lanes_of(shape); ++k) {
    const double exponent = min_exponent * random_int(random, 0, 10000) / 10000;
    cells.push_back(k % lanes_of(shape) < shape.count ? static_cast<float>(std::exp2(exponent))
                                                      : 0.0F);
  }
  return cells;
}

/// Energies of the blocks of two rows, in double: −ln of products, above the least of a column.
std::vector<double> plain_energies(const Shape& shape, const std::vector<float>& upper,
                                   const std::vector<float>& lower) {
  const int lanes = lanes_of(shape);
  std::vector<double> energies;
  for (int b = 0; b < (shape.columns + 1) / 2; ++b) {
    const int left = 2 * b;
    const int right = std::min(2 * b + 1, shape.columns - 1);
    std::vector<double> column;
    for (int i = 0; i < shape.count; ++i) {
      const auto energy = [&](const std::vector<float>& row, int x) {
        return -std::log(static_cast<double>(row[x * lanes + i]));
      };
      column.push_back(energy(upper, left) + energy(upper, right) + energy(lower, left) +
                       energy(lower, right));
    }
    const double min = *std::min_element(column.begin(), column.end());
    for (const double energy : column) {
      energies.push_back(energy - min);
    }
  }
  return energies;
}

constexpr float kWeights[] = {1, 0.6F, 0.015F};

TEST(CompactLikelihoods, EnergiesOfBlocksAreWeightedSums) {
  std::mt19937 random(1);
  for (const Shape& shape : kShapes) {
    const float weight = kWeights[random() % std::size(kWeights)];
    for (const bool has_lower : {true, false}) {
      const int lanes = lanes_of(shape);
      const auto upper = random_likelihoods(shape, -20, random);
      const auto lower = has_lower ? random_likelihoods(shape, -20, random) : upper;
      const BlockRow<float> row{upper.data(), lower.data(), shape.columns, lanes};
      const auto cells = static_cast<std::size_t>(row.blocks() * lanes);
      std::vector<float> work(lanes, -7);
      const auto reduced = row_on_every_target<std::uint8_t>(cells, reduce_likelihoods_row, row,
                                                             weight, work.data());
      const auto plain = plain_energies(shape, upper, lower);
      for (std::size_t k = 0; k < cells; ++k) {
        const auto lane = static_cast<int>(k) % lanes;
        if (lane >= shape.count) {
          const std::size_t first = k - static_cast<std::size_t>(lane);
          ASSERT_GE(reduced[k], *std::max_element(&reduced[first], &reduced[first] + shape.count));
          continue;
        }
        const std::size_t block = k / static_cast<std::size_t>(lanes);
        const double energy =
            weight *
            plain[block * static_cast<std::size_t>(shape.count) + static_cast<std::size_t>(lane)];
        ASSERT_NEAR(reduced[k] * kEnergyStep, std::min(energy, kMaxCompact * kEnergyStep + 0.0),
                    kEnergyStep / 2 + 1e-4);
      }
    }
  }
}

TEST_P(CompactLikelihoods, VanishingLikelihoodsStayFinite) {
  const std::vector<float> zero(16, 0.0F);
  std::vector<float> one_seen(16, 0.0F);
  one_seen[3] = 1;
  const BlockRow<float> row{one_seen.data(), zero.data(), 1, 16};
  std::vector<float> work(16);
  std::vector<std::uint8_t> energies(16);
  reduce_likelihoods_row(row, 1, work.data(), energies.data());
  EXPECT_EQ(energies[3], 0);
  EXPECT_EQ(energies[2], kMaxCompact);
  EXPECT_EQ(energies[15], kMaxCompact);
}

/// Sums of the blocks above the least of their column, times the weight, halves rounded up.
std::vector<std::uint8_t> plain_compact(const BlockRow<std::uint8_t>& row, float weight) {
  const double units = std::round(weight * kCompactWeightUnits) / kCompactWeightUnits;
  std::vector<std::uint8_t> energies;
  for (int b = 0; b < row.blocks(); ++b) {
    std::vector<int> sums;
    for (int lane = 0; lane < row.lanes; ++lane) {
      const std::ptrdiff_t left = row.left(b) + lane;
      const std::ptrdiff_t right = row.right(b) + lane;
      sums.push_back(row.upper[left] + row.upper[right] + row.lower[left] + row.lower[right]);
    }
    const int min = *std::min_element(sums.begin(), sums.end());
    for (const int sum : sums) {
      const double energy = std::floor((sum - min) * units + 0.5);
      energies.push_back(static_cast<std::uint8_t>(std::min<double>(energy, kMaxCompact)));
    }
  }
  return energies;
}

TEST_P(CompactLikelihoods, CompactEnergiesOfBlocksAreWeightedSums) {
  std::mt19937 random(2);
  for (const Shape& shape : kShapes) {
    const int lanes = lanes_of(shape);
    std::vector<std::uint8_t> rows[2];
    for (auto& cells : rows) {
      for (int k = 0; k < shape.columns * lanes; ++k) {
        const int max = k % 3 == 0 ? kMaxCompact : 60;
        cells.push_back(static_cast<std::uint8_t>(
            k % lanes < shape.count ? random_int(random, 0, max) : kMaxCompact));
      }
    }
    for (const int lower : {0, 1}) {
      const float weight = kWeights[random() % std::size(kWeights)];
      const BlockRow<std::uint8_t> row{rows[0].data(), rows[lower].data(), shape.columns, lanes};
      const auto cells = static_cast<std::size_t>(row.blocks() * lanes);
      GuardedRow<std::uint8_t> actual(cells, 5, 77);
      GuardedRow<std::uint16_t> work(lanes, 3, 7777);
      reduce_compact_energies_row(row, weight, work.data(), actual.data());
      EXPECT_TRUE(work.intact());
      EXPECT_TRUE(actual.intact());
      ASSERT_EQ(actual.values(), plain_compact(row, weight)) << shape.columns << " columns";
    }
  }
}

TEST_P(CompactLikelihoods, SlantsTakeTheSmallestOfThreeCandidates) {
  std::mt19937 random(4);
  for (const Shape& shape : kShapes) {
    const int lanes = lanes_of(shape);
    for (const int penalty : {0, 4, 200, kMaxCompact - 1}) {
      const auto cells = static_cast<std::size_t>(shape.columns * lanes);
      GuardedRow<std::uint8_t> actual(cells, 5, 77);
      for (std::size_t k = 0; k < cells; ++k) {
        const bool is_candidate = static_cast<int>(k) % lanes < shape.count;
        actual.data()[k] = static_cast<std::uint8_t>(
            is_candidate ? random_int(random, 0, kMaxCompact) : kMaxCompact);
      }
      const std::vector<std::uint8_t> before = actual.values();
      std::vector<std::uint8_t> plain;
      for (int k = 0; k < shape.columns * lanes; ++k) {
        int min = before[k];
        for (const int beside : {k - 1, k + 1}) {
          if (beside >= 0 && beside / lanes == k / lanes && beside < shape.columns * lanes) {
            min = std::min(min, before[beside] + penalty);
          }
        }
        plain.push_back(static_cast<std::uint8_t>(min));
      }
      allow_slant_row(actual.data(), shape.columns, lanes, static_cast<std::uint8_t>(penalty));
      EXPECT_TRUE(actual.intact());
      ASSERT_EQ(actual.values(), plain) << shape.columns << " columns of " << shape.count;
    }
  }
}

TEST_P(CompactLikelihoods, AddsUpAndSubtractsTheLeast) {
  // Lanes 0, 1 and 2 of three columns: blocks {0, 1} and {2}.
  std::vector<std::uint8_t> upper(48, 255);
  std::vector<std::uint8_t> lower(48, 255);
  const auto set = [](std::vector<std::uint8_t>& row, int column, int a, int b, int c) {
    const int values[] = {a, b, c};
    for (int lane = 0; lane < 3; ++lane) {
      row[16 * column + lane] = static_cast<std::uint8_t>(values[lane]);
    }
  };
  set(upper, 0, 0, 10, 200);
  set(upper, 1, 5, 0, 200);
  set(lower, 0, 7, 0, 0);
  set(lower, 1, 0, 1, 3);
  set(upper, 2, 0, 20, 100);
  set(lower, 2, 1, 0, 100);
  std::vector<std::uint8_t> energies(32);
  std::vector<std::uint16_t> work(16);
  const BlockRow<std::uint8_t> row{upper.data(), lower.data(), 3, 16};
  reduce_compact_energies_row(row, 1, work.data(), energies.data());
  EXPECT_EQ(energies[0], 1);    // 12 − 11
  EXPECT_EQ(energies[1], 0);    // 11
  EXPECT_EQ(energies[2], 255);  // 403 − 11
  EXPECT_EQ(energies[16], 0);   // 2 · (0 + 1)
  EXPECT_EQ(energies[17], 38);  // 2 · (20 + 0) − 2
  EXPECT_EQ(energies[18], 255);
  reduce_compact_energies_row(row, 0.5F, work.data(), energies.data());
  EXPECT_EQ(energies[0], 1);  // ½, rounded up
  EXPECT_EQ(energies[2], 196);
  EXPECT_EQ(energies[17], 19);
  EXPECT_EQ(energies[18], 199);
}

TEST(CompactLikelihoods, ExpandToPowers) {
  for (const Shape& shape : kShapes) {
    const int lanes = lanes_of(shape);
    std::vector<std::uint8_t> cells;
    for (int k = 0; k < shape.columns * lanes; ++k) {
      cells.push_back(static_cast<std::uint8_t>(k * 37 % 256));
    }
    const CompactRow row{cells.data(), shape.columns, lanes, shape.count};
    const auto likelihoods =
        row_on_every_target<float>(cells.size(), likelihoods_of_compact_row, row);
    const auto probabilities =
        row_on_every_target<float>(cells.size(), probabilities_of_compact_row, row);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const bool is_candidate = static_cast<int>(k) % lanes < shape.count;
      const double likelihood = is_candidate ? std::exp(-cells[k] / 8.0) : 0;
      const double probability = is_candidate ? std::exp2(-cells[k] / 8.0) : 0;
      ASSERT_NEAR(likelihoods[k], likelihood, 1e-5 * likelihood);
      ASSERT_NEAR(probabilities[k], probability, 1e-5 * probability);
    }
  }
}

TEST(CompactLikelihoods, ProbabilitiesSurviveToHalfAStep) {
  std::mt19937 random(3);
  std::vector<float> probabilities = {0, 1, 0.5F, 1e-38F, 1e-30F, 1.0000001F, 0.999F, 0.25F};
  while (probabilities.size() < 256) {
    probabilities.push_back(static_cast<float>(std::exp2(-random_int(random, 0, 36000) / 1000.0)));
  }
  const auto reference = row_on_every_target<std::uint8_t>(
      probabilities.size(), compact_probabilities_row, probabilities.data(),
      static_cast<int>(probabilities.size()));
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    const double exponent = probabilities[k] > 0 ? -std::log2(probabilities[k]) : 1000;
    ASSERT_NEAR(reference[k] / 8.0, std::clamp(exponent, 0.0, 255 / 8.0), 0.5 / 8 + 1e-5);
  }
}

}  // namespace vantage::kernels::compact_likelihoods_test
