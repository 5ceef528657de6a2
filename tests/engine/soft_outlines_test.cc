#include "engine/synthesis/soft_outlines.h"
#include "tests/engine/engine_test.h"
#include "tests/test_sample.h"

namespace vantage::soft_outlines_test {

// Any function of the question, unknown for some.
double some_coverage(const SurfaceEdge& edge) {
  const int mixed = 7 * edge.surface_x + 13 * edge.surface_y + 3 * edge.x + 5 * edge.y +
                    static_cast<int>(std::lround(2 * edge.nearness + 3 * edge.background_nearness));
  const int part = ((mixed % 11) + 11) % 11;
  return part == 10 ? std::numeric_limits<double>::quiet_NaN() : part / 9.0;
}

DisparityMap random_nearness(std::mt19937& random, int width, int height) {
  DisparityMap map(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    const auto event = random() % 12;
    const float before = x > 0 ? map.at(x - 1, y) : 3.0F;
    map.at(x, y) = event == 0                        ? std::numeric_limits<float>::quiet_NaN()
                   : event < 4 || std::isnan(before) ? static_cast<float>(random() % 9)
                                                     : before;
  }
  return map;
}

/// The contract, pixel by pixel: what `image` becomes at (x, y), before rounding.
template <typename T>
std::vector<double> plain(const Image<T>& image, const DisparityMap& nearness, int x, int y) {
  const auto channels = static_cast<std::size_t>(image.channels());
  const auto value = [&](int column, int line, std::size_t c) {
    return static_cast<double>(image.at(column, line, static_cast<int>(c)));
  };
  std::vector<double> colour(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    colour[c] = value(x, y, c);
  }
  const float own = nearness.at(x, y);
  std::vector<std::pair<int, int>> farther;
  std::vector<std::pair<int, int>> nearer;
  float farthest = std::numeric_limits<float>::infinity();
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const int column = x + dx;
    const int line = y + dy;
    if (column < 0 || line < 0 || column >= image.width() || line >= image.height()) {
      continue;
    }
    const float there = nearness.at(column, line);
    if (own - there > 1) {
      farther.emplace_back(column, line);
      farthest = std::min(farthest, there);
    }
    if (there - own > 1) {
      nearer.emplace_back(column, line);
    }
  }
  if (!farther.empty()) {
    const double covered = some_coverage({x, y, x, y, own, farthest});
    for (std::size_t c = 0; c < channels && !std::isnan(covered); ++c) {
      double mean = 0;
      for (const auto& [column, line] : farther) {
        mean += value(column, line, c) / static_cast<double>(farther.size());
      }
      colour[c] = covered * colour[c] + (1 - covered) * mean;
    }
  }
  double max = 0;
  double sum = 0;
  std::vector<double> sums(channels);
  for (const auto& [column, line] : nearer) {
    const double covered = some_coverage({column, line, x, y, nearness.at(column, line), own});
    if (!std::isnan(covered)) {
      max = std::max(max, covered);
      sum += covered;
      for (std::size_t c = 0; c < channels; ++c) {
        sums[c] += covered * value(column, line, c);
      }
    }
  }
  for (std::size_t c = 0; c < channels && sum > 0; ++c) {
    colour[c] = (1 - max) * colour[c] + max * sums[c] / sum;
  }
  return colour;
}

template <typename T>
class SoftOutlines : public testing::Test {};
TYPED_TEST_SUITE(SoftOutlines, PixelTypes);

TYPED_TEST(SoftOutlines, EqualThePlainDefinition) {
  constexpr bool kIsFloat = std::is_floating_point_v<TypeParam>;
  std::mt19937 random(1);
  constexpr std::pair<int, int> kSizes[] = {{1, 1},  {1, 9},  {9, 1},    {17, 33},
                                            {64, 3}, {65, 5}, {1024, 2}, {1025, 3}};
  for (const SampleRow& row : sampled_rows({8, 3, 2})) {
    const auto [width, height] = kSizes[row[0]];
    const int channels = row[1] == 0 ? 1 : row[1] + 2;
    Image<TypeParam> image(width, height, channels);
    for (const auto [k, y] : positions_of(width * channels, height)) {
      image.row(y)[k] = kIsFloat ? static_cast<TypeParam>(static_cast<float>(random() % 1000))
                                 : static_cast<TypeParam>(random());
    }
    const DisparityMap nearness = random_nearness(random, width, height);
    Execution execution(
        {.threads = row[2] == 0 ? 1 : 3, .executor = scheduler::ExecutorKind::kOpenMp});
    Image<TypeParam> softened = image.copy();
    soften_outlines<TypeParam>(some_coverage, nearness.view(), 1, softened.view(), execution);
    for (const auto [x, y] : positions_of(width, height)) {
      const std::vector<double> expected = plain(image, nearness, x, y);
      for (int c = 0; c < channels; ++c) {
        ASSERT_NEAR(static_cast<double>(softened.at(x, y, c)),
                    expected[static_cast<std::size_t>(c)], kIsFloat ? 1e-3 : 0.50001)
            << width << "×" << height << " at " << x << ", " << y;
      }
    }
    EXPECT_LE(execution.scratch().bytes_held(),
              outline_bytes(width, height, channels, sizeof(TypeParam)) + 64);
  }
}

TEST(SoftOutlinesOfOneSurface, AreNone) {
  DisparityMap nearness(70, 20);
  for (const auto [x, y] : positions_of(70, 20)) {
    nearness.at(x, y) = static_cast<float>(x - y);  // steps of the limit, not above
  }
  Image<std::uint8_t> image(70, 20, 1);
  image.fill(9);
  int questions = 0;
  soften_outlines<std::uint8_t>(
      [&](const SurfaceEdge& /*edge*/) {
        ++questions;
        return 0.5;
      },
      nearness.view(), 1, image.view(), execution());
  EXPECT_EQ(questions, 0);
}

}  // namespace vantage::soft_outlines_test
