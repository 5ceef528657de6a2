#include "kernels/hole_fill/hole_fill.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::hole_fill_test {

// One letter per pixel; disparities as digits, '.' = hole.
std::string fill(std::string pixels, const std::string& disparities, bool mirror = true,
                 int mixed_px = 0) {
  std::vector<std::uint8_t> values(pixels.begin(), pixels.end());
  std::vector<float> d;
  for (const char digit : disparities) {
    d.push_back(digit == '.' ? kUnknownDisparity : static_cast<float>(digit - '0'));
  }
  fill_holes_row(HoleFillRow<std::uint8_t>{.pixels = values.data(),
                                           .disparity_px = d.data(),
                                           .width = static_cast<int>(d.size()),
                                           .channels = 1,
                                           .gradient_limit_px = 1,
                                           .mixed_px = mixed_px},
                 mirror);
  return {values.begin(), values.end()};
}

TEST(HoleFill, MirrorsTheBackgroundSide) {
  EXPECT_EQ(fill("abcd___xyz", "1111...555"), "abcddcbxyz");
  EXPECT_EQ(fill("abc___wxyz", "555...1111"), "abcyxwwxyz");
}

TEST(HoleFill, EqualSidesTakeTheLeft) { EXPECT_EQ(fill("abc__xyz", "333..333"), "abccbxyz"); }

TEST(HoleFill, HoleAtTheBorderHasOneSide) {
  EXPECT_EQ(fill("__abcd", "..9999"), "baabcd");
  EXPECT_EQ(fill("abcd__", "9999.."), "abcddc");
}

TEST(HoleFill, ReflectsWhereTheRunEnds) {
  EXPECT_EQ(fill("ab_____xy", "11.....55"), "abbaabbxy");        // image border
  EXPECT_EQ(fill("pqab____xy", "7711....55"), "pqabbaabxy");     // disparity jump
  EXPECT_EQ(fill("pq_ab____xy", "11.11....55"), "pqqabbaabxy");  // another hole
  EXPECT_EQ(fill("a____", "1...."), "aaaaa");
}

TEST(HoleFill, ASlopeIsNoJump) { EXPECT_EQ(fill("abcd____", "4321...."), "abcddcba"); }

TEST(HoleFill, SpreadRepeatsTheBorderPixel) {
  EXPECT_EQ(fill("abcd___xyz", "1111...555", false), "abcddddxyz");
}

// The background's pixel beside the hole is taken for a mixture.
TEST(HoleFill, ReplacesMixedPixels) {
  EXPECT_EQ(fill("abcd___xyz", "1111...555", true, 1), "abccbaaxyz");
  EXPECT_EQ(fill("abc___wxyz", "555...1111", true, 1), "abczzyxxyz");
  EXPECT_EQ(fill("abcd___xyz", "1111...555", false, 2), "abbbbbbxyz");
  EXPECT_EQ(fill("abc__xyz", "333..333", true, 1), "abccbxyz");  // one surface on both sides
  EXPECT_EQ(fill("__abcd", "..9999", true, 1), "baabcd");        // nothing hid the rest
  EXPECT_EQ(fill("pa____xy", "71....55", true, 1), "paaaaaxy");  // no other pixel behind it
  EXPECT_EQ(fill("a____xy", "1....55", true, 1), "aaaaaxy");
}

TEST(HoleFill, TellsWhatItHasFilled) {
  std::vector<std::uint8_t> pixels = {1, 2, 3, 0, 0, 6, 0};
  const std::vector<float> d = {
      1, 1, 2, kUnknownDisparity, kUnknownDisparity, 7, kUnknownDisparity};
  std::vector<float> filled_d(7);
  std::vector<std::uint8_t> filled(7, 9);
  fill_holes_row(HoleFillRow<std::uint8_t>{.pixels = pixels.data(),
                                           .disparity_px = d.data(),
                                           .width = 7,
                                           .channels = 1,
                                           .gradient_limit_px = 1,
                                           .mixed_px = 1,
                                           .filled_disparity_px = filled_d.data(),
                                           .filled = filled.data()},
                 true);
  EXPECT_EQ(filled_d, (std::vector<float>{1, 1, 1, 1, 1, 7, 7}));
  EXPECT_EQ(filled, (std::vector<std::uint8_t>{0, 0, 255, 255, 255, 0, 255}));
  EXPECT_EQ(pixels, (std::vector<std::uint8_t>{1, 2, 2, 1, 1, 6, 6}));
}

TEST(HoleFill, NothingToCopyFrom) { EXPECT_EQ(fill("___", "..."), "___"); }

// The definition, as an index computed for each hole position by itself.
TEST(HoleFill, EqualsPlainDefinitionOnRandomRows) {
  std::mt19937 random(11);
  for (const int width : kAwkwardWidths) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<float> d(width);
      bool hole = false;
      for (float& value : d) {
        hole = random() % 3 == 0 ? !hole : hole;
        value = hole ? kUnknownDisparity : static_cast<float>(random() % 4);
      }
      std::vector<std::uint16_t> pixels;
      for (int k = 0; k < 3 * width; ++k) {
        pixels.push_back(static_cast<std::uint16_t>(k));
      }
      const auto at = [&](int x) { return d[x]; };
      const auto known = [&](int x) { return x >= 0 && x < width && !std::isnan(at(x)); };
      std::vector<std::uint16_t> expected = pixels;
      for (int x = 0; x < width; ++x) {
        if (known(x)) {
          continue;
        }
        int left = x;
        int right = x;
        while (left >= 0 && !known(left)) {
          --left;
        }
        while (right < width && !known(right)) {
          ++right;
        }
        if (left < 0 && right == width) {
          continue;
        }
        const bool use_left = right == width || (left >= 0 && at(left) <= at(right));
        const int border = use_left ? left : right;
        const int step = use_left ? -1 : 1;
        int run = 1;
        while (known(border + run * step) &&
               std::abs(at(border + run * step) - at(border + (run - 1) * step)) <= 1) {
          ++run;
        }
        const int k = (std::abs(x - border) - 1) % (2 * run);
        const int source = border + (k < run ? k : 2 * run - 1 - k) * step;
        for (int c = 0; c < 3; ++c) {
          expected[3 * x + c] = pixels[3 * source + c];
        }
      }
      fill_holes_row(HoleFillRow<std::uint16_t>{.pixels = pixels.data(),
                                                .disparity_px = d.data(),
                                                .width = width,
                                                .channels = 3,
                                                .gradient_limit_px = 1},
                     true);
      ASSERT_EQ(pixels, expected);
    }
  }
}

}  // namespace vantage::kernels::hole_fill_test
