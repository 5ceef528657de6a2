#include "engine/scene_graph/sheared_images.h"

#include "tests/engine/engine_test.h"

namespace vantage::sheared_images_test {

/// A smooth picture, 0..1, that can be looked at anywhere.
double intensity_at(double x, double y) {
  return 0.5 + 0.2 * std::sin(0.31 * x + 0.12 * y) + 0.2 * std::cos(0.17 * x - 0.29 * y);
}

Photograph picture(int width, int height, double right, double down) {
  Image<float> image(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    image.at(x, y) = static_cast<float>(intensity_at(x + right, y + down));
  }
  Photograph photograph;
  photograph.pixels = std::move(image);
  return photograph;
}

const std::vector<std::pair<int, int>> kSizes = {{1, 1}, {1, 9}, {13, 1}, {31, 17}, {67, 40}};

TEST(ShearedImages, ShowEveryPositionOnItsLine) {
  for (const double slope : {-1.0, -0.37, 0.0, 0.2, 1.0}) {
    for (const auto& [width, height] : kSizes) {
      const Shear shear(slope, width);
      const Photograph result = sheared(picture(width, height, 0, 0), shear, execution());
      const auto& image = std::get<Image<float>>(result.pixels);
      ASSERT_EQ(image.width(), width);
      ASSERT_EQ(image.height(), shear.height(height, width));
      for (const auto [x, y] : positions_of(width, image.height())) {
        const double row = y + slope * x - shear.offset;
        const double last = height - 1;
        if ((row > 1 && row < last - 1) || row <= 0 || row >= last) {
          ASSERT_NEAR(image.at(x, y), intensity_at(x, std::clamp(row, 0.0, last)), 2e-3)
              << slope << " " << width << "x" << height << " at " << x << "," << y;
        }
      }
      // Nothing is cut off: the rows of the corners lie inside.
      for (const int x : {0, width - 1}) {
        EXPECT_GE(-slope * x + shear.offset, 0);
        EXPECT_LE(height - 1 - slope * x + shear.offset, image.height() - 1);
      }
    }
  }
}

TEST(ShearedImages, RowsOfAnObliquePairCorrespond) {
  constexpr double kDisparity = 6;  // along x
  for (const double slope : {-0.8, 0.45}) {
    const Shear shear(slope, 90);
    const Photograph first = sheared(picture(90, 50, 0, 0), shear, execution());
    const Photograph second =
        sheared(picture(90, 50, kDisparity, slope * kDisparity), shear, execution());
    const auto& left = std::get<Image<float>>(first.pixels);
    const auto& right = std::get<Image<float>>(second.pixels);
    int compared = 0;
    for (const auto [x, y] : positions_of({6, 90}, {0, left.height()})) {
      const double row = y + slope * x - shear.offset;
      const double partner = row - slope * kDisparity;
      if (std::min(row, partner) > 1 && std::max(row, partner) < 48) {
        ASSERT_NEAR(left.at(x, y), right.at(x - 6, y), 2e-3) << x << "," << y;
        ++compared;
      }
    }
    EXPECT_GT(compared, 3000);
  }
}

TEST(ShearedImages, MapsComeBackToTheImage) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (const double slope : {-1.0, -0.37, 0.0, 0.2, 1.0}) {
    for (const auto& [width, height] : kSizes) {
      const Shear shear(slope, width);
      DisparityMap map(width, shear.height(height, width));
      Mask mask(width, map.height());
      for (const auto [x, y] : positions_of(width, map.height())) {
        // Unknown along a line that is a row of the image.
        const double row = y + slope * x - shear.offset;
        const bool is_unknown = std::abs(row - 5) <= 0.5;
        map.at(x, y) = is_unknown ? kUnknown : static_cast<float>(0.3 * row + 0.1 * x);
        mask.at(x, y) = is_unknown ? 255 : 0;
      }
      const DisparityMap back = unsheared_disparity(map.view(), shear, height, execution());
      const Mask mask_back = unsheared_mask(mask.view(), shear, height);
      ASSERT_EQ(back.height(), height);
      for (const auto [x, y] : positions_of(width, height)) {
        const double row = y - slope * x + shear.offset;
        if (std::abs(row - std::floor(row) - 0.5) > 1e-9) {  // else two rows are as near
          EXPECT_EQ(mask_back.at(x, y), y == 5 ? 255 : 0) << slope << " " << x << "," << y;
        }
        if (y < 4 || y > 6) {
          ASSERT_NEAR(back.at(x, y), 0.3 * y + 0.1 * x, 1e-4) << slope << " " << x << "," << y;
        } else if (y == 5) {
          ASSERT_TRUE(std::isnan(back.at(x, y)));
        }
      }
    }
  }
}

TEST(ShearedImages, SurfacesAreNotMixed) {
  const Shear shear(0.5, 4);
  DisparityMap map(4, shear.height(6, 4));
  for (const auto [x, y] : positions_of(4, map.height())) {
    map.at(x, y) = y < 4 ? 2.0F : 30.0F;
  }
  const DisparityMap back = unsheared_disparity(map.view(), shear, 6, execution());
  for (const auto [x, y] : positions_of(4, 6)) {
    const double row = y - 0.5 * x + shear.offset;
    EXPECT_EQ(back.at(x, y), row < 3.5 ? 2.0F : 30.0F) << x << "," << y;
  }
}

TEST(ShearedImages, PartnersBeyondTheBorderAreGuesses) {
  const Shear shear(0.5, 20);
  DisparityMap map(20, 30);
  for (int y = 0; y < 30; ++y) {
    std::fill_n(map.row(y), 20, y == 15 ? std::numeric_limits<float>::quiet_NaN() : 8.0F);
  }
  for (const int direction : {-1, 1}) {
    Mask unmatched(20, 30);
    unmatched.fill(0);
    mark_partners_beyond_border(map.view(), shear, direction, unmatched.view());
    for (int y = 0; y < 30; ++y) {
      const int partner = y + 4 * direction;
      EXPECT_EQ(unmatched.at(7, y), partner < 0 || partner > 29 || y == 15 ? 255 : 0) << y;
    }
  }
}

TEST(ShearedImages, EqualForAnyExecutionAndDepth) {
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution many({.threads = 3, .band_height_px = 5});
  const Shear shear(-0.61, 37);
  const Photograph source = noise<std::uint8_t>(37, 23, 3);
  EXPECT_TRUE(same(sheared(source, shear, one), sheared(source, shear, many)));
  const Photograph deep = noise<std::uint16_t>(37, 23, 1);
  EXPECT_TRUE(same(sheared(deep, shear, one), sheared(deep, shear, many)));
}

}  // namespace vantage::sheared_images_test
