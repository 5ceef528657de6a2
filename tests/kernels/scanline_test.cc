#include "kernels/scanline/scanline.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::scanline_test {

VANTAGE_ON_EVERY_TARGET(Scanline);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A row of energies, its candidates, and the costs of changes.
struct Scene {
  CellRow row;
  JumpCost jump;
  std::vector<float> cells;

  /// Values are multiples of 1/4: sums are exact, and many are equal.
  Scene(std::mt19937& random, int width, int count, int disparity_min, int direction,
        JumpCost costs)
      : jump(costs) {
    row.geometry = {width, disparity_min, count, direction};
    row.columns = width;
    const auto lanes = static_cast<std::size_t>(row.geometry.lanes());
    cells.resize(static_cast<std::size_t>(width) * lanes);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool is_candidate = static_cast<int>(i % lanes) < count;
      cells[i] = is_candidate ? static_cast<float>(random_int(random, -8, 32)) / 4 : -1e30F;
    }
    row.cells = cells.data();
  }
  [[nodiscard]] float energy(int x, int i) const { return cells[x * row.geometry.lanes() + i]; }
  /// Σ E + Σ V of a row's candidates; infinite where one of them does not count.
  [[nodiscard]] double total(const std::vector<std::int32_t>& path) const {
    double sum = 0;
    int before = kNoWinner;
    for (int x = 0; x < row.columns; ++x) {
      const CandidateRange candidates = row.candidates(x);
      const int i = path[x];
      if (candidates.empty()) {
        before = kNoWinner;
        continue;
      }
      if (i < candidates.begin || i >= candidates.end) {
        return std::numeric_limits<double>::infinity();
      }
      sum += energy(x, i);
      if (before != kNoWinner) {
        sum +=
            std::min<double>(static_cast<double>(jump.penalty) * std::abs(i - before), jump.limit);
      }
      before = i;
    }
    return sum;
  }
};

struct Result {
  std::vector<std::int32_t> winners;
  std::vector<float> paths;
  std::vector<float> minima;
};

Result result_of(const Scene& scene) {
  const auto columns = static_cast<std::size_t>(scene.row.columns);
  const auto aligned = [](std::size_t count) { return (count + 15) / 16 * 16; };
  const std::size_t paths = scene.cells.size();
  const auto spread =
      static_cast<std::size_t>(scanline_spread_floats(scene.row.geometry, scene.jump));
  // Cells as the address sanitizer likes them: one allocation, aligned by hand.
  std::vector<float> memory(paths + aligned(columns) + aligned(spread) + 16, -7);
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  float* at = memory.data() + (64 - address % 64) % 64 / sizeof(float);
  const ScanlineWork work{at, at + paths, at + paths + aligned(columns)};
  Result result;
  result.winners.assign(columns, -99);
  scanline_winners_row(scene.row, scene.jump, work, result.winners.data());
  result.paths.assign(work.paths, work.paths + paths);
  result.minima.assign(work.minima, work.minima + columns);
  return result;
}

/// The minimum of the total over every choice of candidates, one after the other.
double enumerated_minimum(const Scene& scene) {
  std::vector<std::int32_t> path(scene.row.columns, 0);
  double min = std::numeric_limits<double>::infinity();
  for (;;) {
    min = std::min(min, scene.total(path));
    std::size_t x = 0;
    while (x < path.size() && ++path[x] == scene.row.geometry.count) {
      path[x++] = 0;
    }
    if (x == path.size()) {
      return min;
    }
  }
}

const JumpCost kJumps[] = {{0, 0},       {0.25F, 0.5F}, {1, 1},           {2, 1},
                           {0.5F, 2.5F}, {0.25F, 3},    {0.5F, kInfinity}};

TEST_P(Scanline, IsTheCheapestOfAllPaths) {
  std::mt19937 random(3);
  for (const JumpCost& jump : kJumps) {
    for (int run = 0; run < 20; ++run) {
      const int width = random_int(random, 1, 5);
      const int count = random_int(random, 1, 5);
      const Scene scene(random, width, count, random_int(random, -3, 2), run % 2 == 0 ? 1 : -1,
                        jump);
      const Result result = result_of(scene);
      EXPECT_EQ(scene.total(result.winners), enumerated_minimum(scene))
          << width << " columns, " << count << " candidates, costs " << jump.penalty << " up to "
          << jump.limit;
      for (int x = 0; x < width; ++x) {
        EXPECT_EQ(result.winners[x] == kNoWinner, scene.row.candidates(x).empty());
      }
    }
  }
}

TEST(Scanline, IsIdenticalOnEveryInstructionSet) {
  std::mt19937 random(5);
  for (const int count : {1, 15, 16, 17, 64, 131}) {
    for (JumpCost jump : kJumps) {
      const int width = random_int(random, 1, 90);
      Scene scene(random, width, count, random_int(random, -40, 10), random() % 2 == 0 ? 1 : -1,
                  jump);
      scene.row.margin = static_cast<int>(random() % 3);
      const float factor = 1 + static_cast<float>(random() % 1000) / 997;  // sums that are rounded
      for (float& cell : scene.cells) {
        cell *= factor;
      }
      scene.jump.penalty *= factor;
      const Result expected = result_of(scene);
      for_each_target([&] {
        const Result actual = result_of(scene);
        EXPECT_EQ(actual.winners, expected.winners) << count << " candidates";
        EXPECT_EQ(actual.paths, expected.paths) << count << " candidates";
        EXPECT_EQ(actual.minima, expected.minima) << count << " candidates";
      });
    }
  }
}

TEST_P(Scanline, PrefersSmallChangesAndSmallCandidatesOfEqualPaths) {
  std::mt19937 random(7);
  Scene scene(random, 3, 5, -2, 1, {1, 2});  // the partner of candidate i is at x − 2 + i
  std::fill(scene.cells.begin(), scene.cells.end(), 3.0F);
  EXPECT_EQ(result_of(scene).winners, (std::vector<std::int32_t>{2, 2, 2}));
  // The last column may as well end at 0 and come from there.
  scene.cells[2] = scene.cells[static_cast<std::size_t>(scene.row.geometry.lanes()) + 1] = 1;
  EXPECT_EQ(result_of(scene).winners, (std::vector<std::int32_t>{2, 1, 1}));
}

}  // namespace vantage::kernels::scanline_test
