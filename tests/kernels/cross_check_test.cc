#include "kernels/cross_check/cross_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {
namespace cross_check_test {

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
             double tolerance_px, std::size_t x) {
  if (std::isnan(own[x])) {
    return false;
  }
  const double shift = own[x];
  const auto partner = value_at(other, static_cast<double>(x) + (direction < 0 ? -shift : shift));
  return partner && std::abs(shift - static_cast<double>(*partner)) < tolerance_px;
}

std::vector<std::uint8_t> checked(const std::vector<float>& own, const std::vector<float>& other,
                                  int direction, double tolerance_px) {
  GuardedRow<std::uint8_t> unmatched(own.size(), 3, kSentinel);
  GuardedRow<std::uint8_t> reference(own.size(), 3, kSentinel);
  const int width = static_cast<int>(own.size());
  cross_check_row(own.data(), other.data(), direction, tolerance_px, width, unmatched.data());
  cross_check_row_ref(own.data(), other.data(), direction, tolerance_px, width, reference.data());
  EXPECT_TRUE(unmatched.intact());
  EXPECT_EQ(unmatched.values(), reference.values());
  return unmatched.values();
}

class CrossCheck : public EveryTarget {};
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
      std::vector<float> own(static_cast<std::size_t>(width));
      std::vector<float> other(own.size());
      for (std::size_t x = 0; x < own.size(); ++x) {
        own[x] = draw();
        other[x] = draw();
      }
      const double tolerance_px = 1.0 + 0.25 * round;
      for (const int direction : {-1, 1}) {
        std::vector<std::uint8_t> expected;
        for (std::size_t x = 0; x < own.size(); ++x) {
          expected.push_back(matched(own, other, direction, tolerance_px, x) ? 0 : 255);
        }
        ASSERT_EQ(checked(own, other, direction, tolerance_px), expected)
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

}  // namespace cross_check_test
}  // namespace vantage::kernels
