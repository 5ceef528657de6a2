#include "kernels/intensity_diffusion/intensity_diffusion.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::intensity_diffusion_test {

VANTAGE_ON_EVERY_TARGET(IntensityDiffusion);

std::vector<float> step(const std::vector<float>& centre, const float* up, const float* down) {
  IntensityDiffusionRow row;
  row.up = up;
  row.centre = centre.data();
  row.down = down;
  row.width = static_cast<int>(centre.size());
  row.contrast = 4;
  GuardedRow<float> work(intensity_diffusion_work_floats(row.width), 0, -1);
  GuardedRow<float> output(centre.size(), 3, -1);
  row.work = work.data();
  row.output = output.data();
  intensity_diffusion_row(row);
  EXPECT_TRUE(work.intact());
  EXPECT_TRUE(output.intact());
  return output.values();
}

TEST_P(IntensityDiffusion, MovesEachPixelTowardsItsNeighbours) {
  std::mt19937 random(3);
  for (const std::size_t width : {1U, 2U, 3U, 16U, 37U}) {
    std::vector<std::vector<float>> rows(3);
    for (auto& row : rows) {
      for (std::size_t x = 0; x < width; ++x) {
        row.push_back(static_cast<float>(random_int(random, 0, 30)));
      }
    }
    const auto part = [](double here, double there) {
      return 0.2 * (there - here) * std::exp(-std::abs(there - here) / 4);
    };
    const auto inner = step(rows[1], rows[0].data(), rows[2].data());
    const auto first = step(rows[1], nullptr, rows[2].data());
    for (std::size_t x = 0; x < width; ++x) {
      const double here = rows[1][x];
      double expected = here + part(here, rows[2][x]);
      expected += x > 0 ? part(here, rows[1][x - 1]) : 0;
      expected += x + 1 < width ? part(here, rows[1][x + 1]) : 0;
      ASSERT_NEAR(first[x], expected, 1e-4) << x << " of " << width;
      ASSERT_NEAR(inner[x], expected + part(here, rows[0][x]), 1e-4) << x << " of " << width;
    }
  }
}

TEST_P(IntensityDiffusion, LittleTextureFadesAndStrongEdgesStay) {
  std::vector<float> row;
  for (int x = 0; x < 40; ++x) {
    row.push_back(static_cast<float>(x % 2 + (x < 20 ? 0 : 100)));
  }
  for (int n = 0; n < 20; ++n) {
    row = step(row, nullptr, nullptr);
  }
  EXPECT_NEAR(row[10], row[11], 0.05F);
  EXPECT_NEAR(row[20] - row[19], 100, 0.5F);
}

}  // namespace vantage::kernels::intensity_diffusion_test
