#include "kernels/soft_edges/soft_edges.h"

#include <type_traits>

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::soft_edges_test {

struct Surfaces {
  std::vector<float> d, left_d, right_d;
  OutlineRow row;

  Surfaces(std::mt19937& random, int width) {
    float level = 4;
    for (int x = 0; x < width; ++x) {
      level = random() % 5 == 0 ? static_cast<float>(random() % 80) / 8 : level;
      const auto event = random() % 8;
      d.push_back(event == 0 ? kUnknownDisparity : level);
      left_d.push_back(event <= 2 ? kUnknownDisparity : level + 0.0625F);
      right_d.push_back(event <= 1 || event == 3 ? kUnknownDisparity
                        : event == 4             ? level - 2
                                                 : level - 0.0625F);
    }
    row = {.disparity_px = d.data(),
           .left_disparity_px = left_d.data(),
           .right_disparity_px = right_d.data(),
           .width = width,
           .gradient_limit_px = 1};
  }
};

/// How much of position `other` is in its neighbour `own`, before rounding.
double plain_share(const OutlineRow& row, int own, int other) {
  const auto step = double{row.disparity_px[own]} - row.disparity_px[other];
  if (!(std::abs(step) > row.gradient_limit_px)) {
    return 0;  // or one of them is an open hole
  }
  // The means over the images that show the surface at x; over both if neither does.
  const auto mean = [&](int x, auto&& of_image) {
    const auto shows = [&](float d) { return std::abs(d - row.disparity_px[x]) <= 1; };
    const bool left = shows(row.left_disparity_px[x]);
    const bool right = shows(row.right_disparity_px[x]);
    const double share = left == right ? row.alpha : left ? 1 : 0;
    return (share > 0 ? share * of_image(row.left_offset, row.left_disparity_px[x]) : 0) +
           (share < 1 ? (1 - share) * of_image(row.right_offset, row.right_disparity_px[x]) : 0);
  };
  const int nearer = step > 0 ? own : other;
  const double beside = mean(nearer, [&](double offset, double d) {
    const double column = nearer + offset * d;
    return std::isnan(column) ? 0 : std::floor(column + 0.5) - column;
  });
  // Its outline lies farther out than between the two positions by so much.
  const double out = nearer == std::min(own, other) ? beside : -beside;
  const double covered = own == nearer ? -out : out;
  const double shift =
      mean(step > 0 ? other : own, [&](double offset, double /*d*/) { return std::abs(offset); }) *
      std::abs(step);
  return std::min(1.0, shift / 2) * (0.2 + (covered > 0 ? 0.6 : 0.4) * covered);
}

TEST(OutlineShares, EqualThePlainDefinitionOnEveryInstructionSet) {
  std::mt19937 random(31);
  for (int width : {1, 2, 3, 17, 64, 65, 129, 1023, 1024, 1025, 1026, 2100}) {
    for (int repeat = 0; repeat < 4; ++repeat) {
      Surfaces surfaces(random, width);
      const double view_x = static_cast<double>(random() % 300) / 100 - 1.0;
      surfaces.row.left_offset = view_x;
      surfaces.row.right_offset = view_x - 1;
      surfaces.row.alpha = 0.3F;
      for_each_target([&] {
        std::vector<std::uint8_t> shares(2 * static_cast<std::size_t>(width), 77);
        const int outlines = outline_shares_row(surfaces.row, shares.data());
        int expected_outlines = 0;
        for (int x = 0; x < width; ++x) {
          const double of_left = x > 0 ? plain_share(surfaces.row, x, x - 1) : 0;
          const double of_right = x + 1 < width ? plain_share(surfaces.row, x, x + 1) : 0;
          expected_outlines +=
              x + 1 < width && std::abs(surfaces.d[x] - surfaces.d[x + 1]) > 1 ? 1 : 0;
          ASSERT_NEAR(shares[2 * static_cast<std::size_t>(x)], 256 * of_left, 0.501) << x;
          ASSERT_NEAR(shares[2 * static_cast<std::size_t>(x) + 1], 256 * of_right, 0.501) << x;
        }
        ASSERT_EQ(outlines, expected_outlines);
      });
    }
  }
}

// As the view moves, the outline does: the nearer surface covers exactly what it should, also when
// its last pixel passes to the next position.
TEST(OutlineShares, MoveWithTheView) {
  for (int step = 0; step <= 100; ++step) {
    const double view_x = 0.4 + 0.002 * step;
    std::vector<float> d(10, 2);
    const int end = 8 + static_cast<int>(std::floor(0.5 - 8 * view_x));  // of 8 pixels, moved
    std::fill_n(d.begin(), end, 8.0F);
    std::vector<std::uint8_t> shares(20);
    outline_shares_row({.disparity_px = d.data(),
                        .left_disparity_px = d.data(),
                        .right_disparity_px = d.data(),
                        .width = 10,
                        .gradient_limit_px = 1,
                        .alpha = 1,
                        .left_offset = view_x,
                        .right_offset = view_x - 1},
                       shares.data());
    double covered = 0;
    for (int x = 0; x < 10; ++x) {
      const auto k = static_cast<std::size_t>(2 * x);
      const int other = shares[k] + shares[k + 1];
      covered += x < end ? 1 - other / 256.0 : other / 256.0;
    }
    EXPECT_NEAR(covered, 8 - 8 * view_x, 0.01) << "view " << view_x;
  }
}

template <typename T>
class MixOutlines : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(MixOutlines, PixelTypes);

TYPED_TEST(MixOutlines, EqualThePlainSum) {
  std::mt19937 random(32);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      std::vector<TypeParam> pixels;
      for (int k = 0; k < width * channels; ++k) {
        const double part = static_cast<double>(random() % 10001) / 10000;
        pixels.push_back(static_cast<TypeParam>(part * kLargestValue<TypeParam>));
      }
      const double tolerance = std::is_floating_point_v<TypeParam> ? 1e-6 : 0.501;
      std::vector<std::uint8_t> shares(2 * static_cast<std::size_t>(width));
      for (std::size_t k = 1; k + 1 < shares.size(); ++k) {
        shares[k] = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 129 : 0);
      }
      const std::vector<TypeParam> before = pixels;
      mix_outlines_row(shares.data(), width, channels, pixels.data());
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < channels; ++c) {
          const auto value = [&](int column) {
            return static_cast<double>(before[column * channels + c]);
          };
          double sum = value(x);
          const auto k = static_cast<std::size_t>(2 * x);
          sum += shares[k] == 0 ? 0 : shares[k] / 256.0 * (value(x - 1) - value(x));
          sum += shares[k + 1] == 0 ? 0 : shares[k + 1] / 256.0 * (value(x + 1) - value(x));
          ASSERT_NEAR(static_cast<double>(pixels[x * channels + c]), sum, tolerance);
        }
      }
    }
  }
}

}  // namespace vantage::kernels::soft_edges_test
