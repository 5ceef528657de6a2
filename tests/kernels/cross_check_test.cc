#include "kernels/cross_check/cross_check.h"

#include <array>
#include <optional>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::cross_check_test {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kSentinel = 77;

/// The value of `map` at the pixel nearest to `x`, halves up; none outside and where unknown.
std::optional<float> value_at(const std::vector<float>& map, double x) {
  for (std::size_t column = 0; column < map.size(); ++column) {
    const auto centre = static_cast<double>(column);
    if (x >= centre - 0.5 && x < centre + 0.5) {
      return std::isnan(map[column]) ? std::nullopt : std::optional(map[column]);
    }
  }
  return std::nullopt;
}

/// EQUATIONS §5.2 for one pixel of the left (direction −1) or right map.
bool matched(const std::vector<float>& own, const std::vector<float>& other, int direction,
             double tolerance_px, std::size_t x, float columns_per_px) {
  if (std::isnan(own[x])) {
    return false;
  }
  const double shift = columns_per_px * own[x];
  const auto partner = value_at(other, static_cast<double>(x) + (direction < 0 ? -shift : shift));
  return partner &&
         std::abs(static_cast<double>(own[x]) - static_cast<double>(*partner)) < tolerance_px;
}

std::vector<std::uint8_t> checked(const std::vector<float>& own, const std::vector<float>& other,
                                  int direction, double tolerance_px, float columns_per_px = 1) {
  GuardedRow<std::uint8_t> unmatched(own.size(), 3, kSentinel);
  const CrossCheckRow row{.own_px = own.data(),
                          .direction = direction,
                          .tolerance_px = tolerance_px,
                          .width = static_cast<int>(own.size()),
                          .unmatched = unmatched.data(),
                          .columns_per_px = columns_per_px};
  cross_check_row(row, other.data());
  EXPECT_TRUE(unmatched.intact());
  return unmatched.values();
}

VANTAGE_ON_EVERY_TARGET(CrossCheck);

TEST_P(CrossCheck, EqualsPlainTranscription) {
  std::mt19937 random(51);
  for (int width = 1; width <= 70; ++width) {
    for (int round = 0; round < 40; ++round) {
      // Quarter pixels: partners half way between two columns occur, and so do differences that
      // equal the tolerance.
      const int range = round % 2 == 0 ? 3 : width + 4;
      const auto draw = [&] {
        return random() % 6 == 0
                   ? kUnknown
                   : static_cast<float>(random_int(random, -4 * range, 4 * range)) / 4;
      };
      std::vector<float> own(width);
      std::vector<float> other(own.size());
      for (std::size_t x = 0; x < own.size(); ++x) {
        own[x] = draw();
        other[x] = draw();
      }
      const double tolerance_px = 1.0 + 0.25 * round;
      const float columns_per_px = std::array{1.0F, 0.5F, 0.37F, 1.7F}[round % 4];
      for (const int direction : {-1, 1}) {
        std::vector<std::uint8_t> expected;
        for (std::size_t x = 0; x < own.size(); ++x) {
          expected.push_back(matched(own, other, direction, tolerance_px, x, columns_per_px) ? 0
                                                                                             : 255);
        }
        ASSERT_EQ(checked(own, other, direction, tolerance_px, columns_per_px), expected)
            << "width " << width << ", round " << round << ", direction " << direction;
      }
    }
  }
}

TEST_P(CrossCheck, MarksWhatHasNoPartner) {
  using Mask = std::vector<std::uint8_t>;
  // Single columns: the partner is the pixel itself or outside.
  EXPECT_EQ(checked({0.0F}, {0.0F}, -1, 1), Mask{0});
  EXPECT_EQ(checked({1.0F}, {1.0F}, -1, 1), Mask{255});
  EXPECT_EQ(checked({kUnknown}, {0.0F}, 1, 1), Mask{255});
  EXPECT_EQ(checked({0.0F}, {kUnknown}, 1, 1), Mask{255});
  // Values that fit no integer.
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(checked({infinity, -infinity, 3e38F, -3e38F}, {0, 0, 0, 0}, 1, 1), Mask(4, 255));
  EXPECT_EQ(checked({0, 0, 0, 0}, {infinity, -infinity, 3e38F, 0}, 1, 1), (Mask{255, 255, 255, 0}));
}

TEST_P(CrossCheck, ToleranceItselfIsTooMuch) {
  using Mask = std::vector<std::uint8_t>;
  EXPECT_EQ(checked({0, 0}, {1.0F, 0.9375F}, -1, 1), (Mask{255, 0}));
  EXPECT_EQ(checked({0, 0}, {-1.0F, -0.9375F}, 1, 1), (Mask{255, 0}));
}

TEST_P(CrossCheck, NothingIsRounded) {
  // Differences and partners whose float sums would round to the tolerance and to halves.
  std::mt19937 random(52);
  const auto draw = [&] {
    const float whole = static_cast<float>(random_int(random, -9, 9)) / 2;
    const float scale = std::exp2(static_cast<float>(random_int(random, -30, -20)));
    return whole + scale * static_cast<float>(random_int(random, -3, 3));
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<float> own(70);
    std::vector<float> other(own.size());
    for (std::size_t x = 0; x < own.size(); ++x) {
      own[x] = draw();
      other[x] = draw();
    }
    const double tolerance_px = round % 3 == 0 ? 1.0 : 1 + random_int(random, 0, 40) / 15.0;
    // The tolerance rounded to a float is more or less than it.
    own[69] = 0;
    other[69] = static_cast<float>(tolerance_px);
    checked(own, other, round % 2 == 0 ? -1 : 1, tolerance_px);
  }
}

}  // namespace vantage::kernels::cross_check_test
