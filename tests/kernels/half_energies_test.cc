#include "kernels/half_energies/half_energies.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::half_energies_test {

/// What the bits of a half float mean (IEEE 754 binary16).
double plain_value(std::uint16_t half) {
  const int exponent = (half >> 10) & 31;
  const int significand = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(significand, -24) : std::ldexp(1024 + significand, exponent - 25);
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

std::vector<float> random_energies(std::size_t size, std::mt19937& random) {
  std::vector<float> energies = {0, 1, -1, 65025, 0.1F, -0.3F, 1e-6F, 3e-8F};
  while (energies.size() < size) {
    const double magnitude = std::exp2(random_int(random, -26000, 15900) / 1000.0);
    energies.push_back(static_cast<float>(random() % 2 == 0 ? magnitude : -magnitude));
  }
  energies.resize(size);
  return energies;
}

TEST(HalfFloat, EveryOneComesBack) {
  for (int bits = 0; bits < 0x7C00; ++bits) {
    for (const int sign : {0, 0x8000}) {
      const auto half = static_cast<std::uint16_t>(bits | sign);
      ASSERT_EQ(of_half(half), plain_value(half)) << half;
      ASSERT_EQ(to_half(of_half(half)), half);
    }
  }
}

TEST(HalfFloat, IsTheNearestTheEvenOneOfTwo) {
  constexpr int kMinNormal = 1 << 10;
  for (int bits = kMinNormal; bits + 1 < 0x7C00; bits += 7) {
    const auto below = static_cast<std::uint16_t>(bits);
    const auto above = static_cast<std::uint16_t>(bits + 1);
    const auto middle = static_cast<float>((plain_value(below) + plain_value(above)) / 2);
    EXPECT_EQ(to_half(middle), bits % 2 == 0 ? below : above);
    EXPECT_EQ(to_half(std::nextafter(middle, 0.0F)), below);
    EXPECT_EQ(to_half(std::nextafter(middle, 1e9F)), above);
  }
}

TEST(HalfFloat, IsNearBelowTheNormalOnes) {
  const double step = std::ldexp(1, -24);
  for (int k = 0; k < 4096; ++k) {
    const auto value = static_cast<float>(k * 0.2537 * step);
    EXPECT_NEAR(of_half(to_half(value)), value, step * (0.5 + 1.0 / 8192));
  }
}

TEST(HalfFloat, CutsWhatIsTooLarge) {
  EXPECT_EQ(of_half(to_half(1e9F)), kLargestHalf);
  EXPECT_EQ(of_half(to_half(-std::numeric_limits<float>::infinity())), -kLargestHalf);
}

TEST(HalfEnergies, ComeBackToHalfPrecision) {
  std::mt19937 random(1);
  for (const std::size_t size : {16U, 48U, 256U}) {
    const auto energies = random_energies(size, random);
    for (const float scale : {1.0F, 0.5F}) {
      const auto reference = row_on_every_target<std::uint16_t>(
          size, half_energies_row, energies.data(), static_cast<int>(size), scale);

      const auto back_reference = row_on_every_target<float>(
          size, energies_of_half_row, reference.data(), static_cast<int>(size), 1 / scale);
      for (std::size_t k = 0; k < size; ++k) {
        ASSERT_NEAR(back_reference[k], energies[k], std::abs(energies[k]) / 2048 + 1e-7);
      }
    }
  }
}

TEST(HalfEnergies, OfBlocksAreMeans) {
  std::mt19937 random(2);
  for (const int columns : {1, 2, 3, 7}) {
    for (const int lanes : {16, 48}) {
      const auto size = static_cast<std::size_t>(columns * lanes);
      const auto upper = random_energies(size, random);
      const auto other = random_energies(size, random);
      for (const bool has_lower : {true, false}) {
        const auto& lower = has_lower ? other : upper;
        const BlockRow<float> row{upper.data(), lower.data(), columns, lanes};
        const auto cells = static_cast<std::size_t>(row.blocks() * lanes);
        const auto reference =
            row_on_every_target<std::uint16_t>(cells, reduce_energies_row, row, 0.5F);
        for (std::size_t k = 0; k < cells; ++k) {
          const int lane = static_cast<int>(k) % lanes;
          const int left = static_cast<int>(k) / lanes * 2;
          double sum = 0;
          double magnitude = 0;
          int samples = 0;
          for (int x = left; x < std::min(left + 2, columns); ++x) {
            for (const auto* cells_of_row : {&upper, &lower}) {
              const double energy = (*cells_of_row)[x * lanes + lane];
              sum += energy;
              magnitude += std::abs(energy);
              ++samples;
            }
          }
          ASSERT_NEAR(2 * of_half(reference[k]), sum / samples,
                      std::abs(sum / samples) / 2048 + magnitude * 1e-6 + 1e-7);
        }
      }
    }
  }
}

TEST(HalfEnergies, OfBlocksOfHalvesAreMeans) {
  std::mt19937 random(3);
  for (const int columns : {1, 2, 5, 8}) {
    const auto size = static_cast<std::size_t>(columns * 32);
    std::vector<std::uint16_t> rows[2];
    std::vector<float> plain_rows[2];
    for (int r = 0; r < 2; ++r) {
      plain_rows[r] = random_energies(size, random);
      for (float& energy : plain_rows[r]) {
        rows[r].push_back(to_half(energy));
        energy = of_half(rows[r].back());
      }
    }
    const BlockRow<std::uint16_t> row{rows[0].data(), rows[1].data(), columns, 32};
    const auto cells = static_cast<std::size_t>(row.blocks() * 32);
    const auto reference = row_on_every_target<std::uint16_t>(cells, reduce_half_energies_row, row);
    // The same as of floats of the same value.
    std::vector<std::uint16_t> of_floats(cells);
    reduce_energies_row({plain_rows[0].data(), plain_rows[1].data(), columns, 32}, 1,
                        of_floats.data());
    ASSERT_EQ(reference, of_floats);
  }
}

TEST(HalfEnergies, GoToTheColumnsOfTheirBlock) {
  std::mt19937 random(4);
  for (const int first_column : {0, 1, 6, 7}) {
    for (const int columns : {1, 2, 3, 8}) {
      constexpr int kLanes = 48;
      const int blocks = (first_column + columns - 1) / 2 - first_column / 2 + 1;
      std::vector<std::uint16_t> coarser;
      for (const float energy :
           random_energies(static_cast<std::size_t>(blocks * kLanes), random)) {
        coarser.push_back(to_half(energy));
      }
      const auto size = static_cast<std::size_t>(columns * kLanes);
      const auto own = random_energies(size, random);
      const CoarserRow row{coarser.data(), first_column, columns, kLanes, 2};
      const auto expanded = row_on_every_target<float>(size, energies_from_coarser_row, row);
      const auto mean =
          row_on_every_target<float>(size, energies_with_coarser_row, row, own.data());
      for (std::size_t k = 0; k < size; ++k) {
        const int column = first_column + static_cast<int>(k) / kLanes;
        const int block = column / 2 - first_column / 2;
        const double energy =
            2 * plain_value(coarser[static_cast<std::size_t>(block * kLanes) + k % kLanes]);
        ASSERT_EQ(expanded[k], energy);
        ASSERT_NEAR(mean[k], (own[k] + energy) / 2, 1e-6 * std::abs(energy) + 1e-2);
      }
    }
  }
}

}  // namespace vantage::kernels::half_energies_test
