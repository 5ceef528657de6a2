#include "kernels/symmetric_path/symmetric_path.h"

#include "kernels/winner/winner.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::symmetric_path_test {

/// Both images' cells of a row. Few different energies: many solutions are equally good.
struct Scene {
  SymmetricRow row;
  std::vector<StepEnergy> left;
  std::vector<StepEnergy> right;

  Scene(std::mt19937& random, int width, int count, int disparity_min) {
    row.width = width;
    row.lanes = 16;
    row.count = count;
    row.disparity_min = disparity_min;
    row.match_offset = random_int(random, -3, 1);
    row.unmatched = random_int(random, 1, 5);
    for (std::vector<StepEnergy>* cells : {&left, &right}) {
      for (int i = 0; i < width * row.lanes; ++i) {
        cells->push_back(random() % 12 == 0 ? kNeverMatched
                                            : static_cast<StepEnergy>(random() % 5));
      }
    }
    point();
  }
  Scene(const Scene& other) : row(other.row), left(other.left), right(other.right) { point(); }
  Scene& operator=(const Scene&) = delete;

  void point() {
    row.left = left.data();
    row.right = right.data();
  }
  /// The images exchanged, and each mirrored.
  [[nodiscard]] Scene exchanged() const {
    Scene scene = *this;
    for (int x = 0; x < row.width; ++x) {
      const auto from = static_cast<std::ptrdiff_t>(row.width - 1 - x) * row.lanes;
      const auto to = static_cast<std::ptrdiff_t>(x) * row.lanes;
      std::copy_n(right.begin() + from, row.lanes, scene.left.begin() + to);
      std::copy_n(left.begin() + from, row.lanes, scene.right.begin() + to);
    }
    return scene;
  }
};

struct Matches {
  std::vector<std::int32_t> left;
  std::vector<std::int32_t> right;
};

Matches matches_of(const Scene& scene) {
  const auto width = static_cast<std::size_t>(scene.row.width);
  Matches matches{std::vector<std::int32_t>(width, -9), std::vector<std::int32_t>(width, -9)};
  std::vector<std::int32_t> sums(symmetric_path_sums(scene.row), -1);
  symmetric_matches_row(scene.row, sums.data(), matches.left.data(), matches.right.data());
  return matches;
}

/// The smallest total of all ways to go on after `left` and `right` pixels are decided.
long minimum_from(const Scene& scene, int left, int right) {
  const SymmetricRow& row = scene.row;
  if (left == row.width && right == row.width) {
    return 0;
  }
  long min = std::numeric_limits<long>::max();
  if (left < row.width) {
    min = std::min(min, row.unmatched + minimum_from(scene, left + 1, right));
  }
  if (right < row.width) {
    min = std::min(min, row.unmatched + minimum_from(scene, left, right + 1));
  }
  const int candidate = left - right - row.disparity_min;
  if (left < row.width && right < row.width && candidate >= 0 && candidate < row.count) {
    const auto at = [&](const std::vector<StepEnergy>& cells, int x) {
      return cells[x * row.lanes + candidate];
    };
    if (at(scene.left, left) != kNeverMatched && at(scene.right, right) != kNeverMatched) {
      min = std::min(min, at(scene.left, left) + at(scene.right, right) + row.match_offset +
                              minimum_from(scene, left + 1, right + 1));
    }
  }
  return min;
}

/// Total of matches; fails the test where they are not one to one or cross.
long total_of(const Scene& scene, const Matches& matches) {
  const SymmetricRow& row = scene.row;
  long total = 0;
  int last_right = -1;
  int matched = 0;
  for (int x = 0; x < row.width; ++x) {
    const int candidate = matches.left[x];
    if (candidate == kNoWinner) {
      continue;
    }
    const int right = x - row.disparity_min - candidate;
    EXPECT_GT(right, last_right);
    EXPECT_LT(right, row.width);
    EXPECT_EQ(matches.right[right], candidate);
    last_right = right;
    ++matched;
    total += row.cost(x, candidate);
  }
  EXPECT_EQ(std::count(matches.right.begin(), matches.right.end(), kNoWinner), row.width - matched);
  return total + 2L * (row.width - matched) * row.unmatched;
}

TEST(SymmetricPath, IsTheCheapestOfAllMatchings) {
  std::mt19937 random(2);
  for (int run = 0; run < 400; ++run) {
    const Scene scene(random, random_int(random, 1, 6), random_int(random, 1, 5),
                      random_int(random, -4, 5));
    EXPECT_EQ(total_of(scene, matches_of(scene)), minimum_from(scene, 0, 0))
        << scene.row.width << " columns, candidates from " << scene.row.disparity_min << ", "
        << scene.row.count << " of them, run " << run;
  }
}

TEST(SymmetricPath, ExchangedImagesGiveExchangedMatches) {
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    const Scene scene(random, random_int(random, 1, 40), random_int(random, 1, 16),
                      random_int(random, -20, 20));
    Matches mirrored = matches_of(scene.exchanged());
    std::reverse(mirrored.left.begin(), mirrored.left.end());
    std::reverse(mirrored.right.begin(), mirrored.right.end());
    const Matches matches = matches_of(scene);
    EXPECT_EQ(mirrored.left, matches.right) << run;
    EXPECT_EQ(mirrored.right, matches.left) << run;
  }
}

TEST(SymmetricPath, TakesTheSmallestDisparitiesOfEqualSolutions) {
  std::mt19937 random(4);
  Scene scene(random, 6, 3, 0);
  std::fill(scene.left.begin(), scene.left.end(), StepEnergy{0});
  scene.right = scene.left;
  scene.point();
  EXPECT_EQ(matches_of(scene).left, std::vector<std::int32_t>(6, 0));
}

}  // namespace vantage::kernels::symmetric_path_test
