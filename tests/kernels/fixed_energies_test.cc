#include "kernels/fixed_energies/fixed_energies.h"

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::fixed_energies_test {

VANTAGE_ON_EVERY_TARGET(FixedEnergies);

constexpr FixedEnergy kSentinel = -77;

struct Shape {
  int columns;
  int count;
};
constexpr Shape kShapes[] = {{1, 1},  {2, 3},  {3, 16},  {5, 17},  {1, 33}, {7, 48},
                             {4, 64}, {2, 96}, {2, 113}, {3, 128}, {1, 300}};

int lanes_of(const Shape& shape) { return CandidateGeometry{.count = shape.count}.lanes(); }

std::vector<std::uint8_t> each_byte() {
  std::vector<std::uint8_t> bytes;
  for (int byte = 0; byte < 256; ++byte) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return bytes;
}

TEST(FixedEnergy, WeightsAreRoundedAndBelowOne) {
  EXPECT_EQ(fixed_weight(0), 0);
  EXPECT_EQ(fixed_weight(0.5F), 0x4000);
  EXPECT_EQ(fixed_weight(0.3F), 9830);
  EXPECT_EQ(fixed_weight(0.99999F), 32767);
  EXPECT_EQ(fixed_weight(1), 32767);
  EXPECT_EQ(weighted(1, 0x4000), 1);  // ½, rounded up
  EXPECT_EQ(weighted(3, 0x2000), 1);
  EXPECT_EQ(weighted(kMaxEnergy, 32767), 32766);
  EXPECT_EQ(saturated_sum(30000, 2000), 32000);
  EXPECT_EQ(saturated_sum(30000, 3000), kMaxEnergy);
}

TEST_P(FixedEnergies, OfBytesAreTheirSteps) {
  for (const Shape& shape : kShapes) {
    const int lanes = lanes_of(shape);
    std::vector<std::uint8_t> cells;
    for (int k = 0; k < shape.columns * lanes; ++k) {
      cells.push_back(static_cast<std::uint8_t>(k * 37 % 256));
    }
    for (const float steps : {0.01F, 1.0F, 32.0F, 55.4F, 127.9F}) {
      const CompactRow row{cells.data(), shape.columns, lanes, shape.count};
      const auto energies = written_row(cells.size(), kSentinel, [&](FixedEnergy* out) {
        fixed_energies_of_bytes_row(row, ByteSteps(steps), out);
      });
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const bool is_candidate = static_cast<int>(k) % lanes < shape.count;
        ASSERT_EQ(energies[k], is_candidate ? ByteSteps(steps).of(cells[k]) : kMaxEnergy) << k;
      }
    }
  }
}

TEST_P(FixedEnergies, ColumnsMayBeApart) {
  for (const Shape& shape : kShapes) {
    const int lanes = lanes_of(shape);
    const EnergyPitches pitches{.cells = lanes + 16, .energies = lanes + 48};
    std::vector<std::uint8_t> bytes;
    std::vector<float> likelihoods;
    for (int k = 0; k < shape.columns * (lanes + 16); ++k) {
      bytes.push_back(static_cast<std::uint8_t>(k * 37 % 256));
      likelihoods.push_back(1 / (1 + static_cast<float>(k % 29)));
    }
    const std::vector<FixedEnergy> untouched(shape.columns * (lanes + 48), kSentinel);
    const CompactRow of_bytes{bytes.data(), shape.columns, lanes, shape.count};
    std::vector<FixedEnergy> actual = untouched;
    fixed_energies_of_bytes_row(of_bytes, ByteSteps(3), actual.data(), pitches);
    const auto last = static_cast<std::size_t>((shape.columns - 1) * (lanes + 48));
    EXPECT_EQ(actual[last], ByteSteps(3).of(bytes[(shape.columns - 1) * (lanes + 16)]));
    EXPECT_EQ(actual[last + static_cast<std::size_t>(lanes)], kSentinel);
    const LikelihoodRow of_likelihoods{likelihoods.data(), shape.columns, lanes, shape.count};
    actual = untouched;
    fixed_energies_of_likelihoods_row(of_likelihoods, 256, actual.data(), pitches);
    EXPECT_NEAR(actual[last], -256 * std::log(likelihoods[(shape.columns - 1) * (lanes + 16)]),
                0.6);
    EXPECT_EQ(actual[last + static_cast<std::size_t>(lanes)], kSentinel);
  }
}

TEST_P(FixedEnergies, OfEachByteAreTheRoundedProduct) {
  const std::vector<std::uint8_t> bytes = each_byte();
  for (int units = 1; units < 32768; units += units < 300 ? 1 : 97) {
    const double steps = units / 256.0;
    std::vector<FixedEnergy> energies(bytes.size());
    fixed_energies_of_bytes_row({bytes.data(), 1, 256, 256}, ByteSteps(static_cast<float>(steps)),
                                energies.data());
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      ASSERT_EQ(energies[k], std::floor(bytes[k] * steps + 0.5)) << k << " times " << steps;
    }
  }
}

TEST(ByteSteps, StayBelowTheirLimit) {
  EXPECT_EQ(ByteSteps(1).units(), 256);
  EXPECT_EQ(ByteSteps(0.3F).units(), 77);
  EXPECT_EQ(ByteSteps(std::nextafter(128.0F, 0.0F)).units(), 32767);
  EXPECT_EQ(ByteSteps(std::nextafter(128.0F, 0.0F)).of(255), 32639);
}

TEST_P(FixedEnergies, BytesSurvive) {
  const std::vector<std::uint8_t> bytes = each_byte();
  for (const float steps : {1.001F, 1.5F, 2.0F, 7.3F, 32.0F, 55.4F, 127.9F}) {
    std::vector<FixedEnergy> energies(bytes.size());
    fixed_energies_of_bytes_row({bytes.data(), 1, 256, 256}, ByteSteps(steps), energies.data());
    GuardedRow<std::uint8_t> back(bytes.size(), 1, 77);
    bytes_of_fixed_energies_row(energies.data(), 256, fixed_weight(1 / steps), back.data());
    EXPECT_TRUE(back.intact());
    if (steps < 100) {
      ASSERT_EQ(back.values(), bytes) << steps;
    } else {
      // Bytes a step, in steps of 2⁻¹⁵, are known to a byte then.
      for (std::size_t k = 0; k < bytes.size(); ++k) {
        ASSERT_NEAR(back.values()[k], bytes[k], 1) << steps;
      }
    }
  }
}

TEST_P(FixedEnergies, ToBytesAreTheRoundedProductCut) {
  std::mt19937 random(3);
  std::vector<FixedEnergy> energies = {0, 1, 2, 254, 255, 256, 257, kMaxEnergy - 1, kMaxEnergy};
  while (energies.size() < 320) {
    energies.push_back(
        static_cast<FixedEnergy>(random_int(random, 0, random() % 2 == 0 ? 600 : int{kMaxEnergy})));
  }
  for (const int weight : {0, 1, 255, 1024, 0x4000, 20000, 32767}) {
    const auto bytes_per_step = static_cast<FixedWeight>(weight);
    for (const int cells : {16, 48, 320}) {
      const auto count = static_cast<std::size_t>(cells);
      const UnalignedRow<FixedEnergy> row = [&] {
        UnalignedRow<FixedEnergy> copy(count, 3);
        std::copy_n(energies.begin(), cells, copy.data());
        return copy;
      }();
      const auto reference = written_row(count, std::uint8_t{77}, bytes_of_fixed_energies_row,
                                         row.data(), cells, bytes_per_step);
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ(reference[k], std::min(255.0, std::floor(energies[k] * (weight / 32768.0) + 0.5)))
            << energies[k] << " times " << weight;
      }
    }
  }
}

TEST(FixedEnergies, OfLikelihoodsAreTheirNegativeLogarithms) {
  std::mt19937 random(4);
  for (const Shape& shape : kShapes) {
    for (const float steps_per_nat : {0.7F, 8.0F, 256.0F, 374.0F}) {
      const int lanes = lanes_of(shape);
      UnalignedRow<float> cells(shape.columns * lanes, random() % 4);
      for (std::size_t k = 0; k < cells.size(); ++k) {
        cells[k] = static_cast<float>(std::exp2(-random_int(random, 0, 130000) / 1000.0));
      }
      const LikelihoodRow row{cells.data(), shape.columns, lanes, shape.count};
      const auto reference = row_on_every_target<FixedEnergy>(cells.size(), [&](FixedEnergy* out) {
        fixed_energies_of_likelihoods_row(row, steps_per_nat, out);
      });
      for (std::size_t k = 0; k < cells.size(); ++k) {
        if (static_cast<int>(k) % lanes >= shape.count) {
          ASSERT_EQ(reference[k], kMaxEnergy);
          continue;
        }
        const double min = kMinFixedLikelihood;
        const double energy = -std::log(std::max<double>(cells[k], min)) * steps_per_nat;
        ASSERT_NEAR(reference[k], energy, 0.5 + 1e-3 + 1e-6 * energy) << cells[k];
      }
    }
  }
}

TEST_P(FixedEnergies, OfVanishingLikelihoodsAreThatOfTheLeast) {
  std::vector<float> cells(16, 1.0F);
  cells[1] = 1.0000001F;  // rounded up somewhere
  cells[2] = kMinFixedLikelihood;
  cells[3] = 0;
  cells[4] = std::numeric_limits<float>::denorm_min();
  cells[5] = std::nextafter(kMinFixedLikelihood, 0.0F);
  cells[6] = 1e-30F;
  cells[7] = 0.5F;
  std::vector<FixedEnergy> energies(16);
  fixed_energies_of_likelihoods_row({cells.data(), 1, 16, 16}, 374, energies.data());
  EXPECT_EQ(energies[0], 0);
  EXPECT_EQ(energies[1], 0);
  EXPECT_EQ(energies[7], 259);    // 374 ln 2
  EXPECT_EQ(energies[6], 25835);  // 374 · 30 ln 10
  EXPECT_EQ(energies[2], 32664);  // 374 · 126 ln 2
  for (const std::size_t k : {3U, 4U, 5U}) {
    EXPECT_EQ(energies[k], energies[2]) << k;
  }
  EXPECT_LT(energies[2], kMaxEnergy);
}

}  // namespace vantage::kernels::fixed_energies_test
