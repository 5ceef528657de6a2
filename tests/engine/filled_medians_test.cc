#include "engine/refinement/filled_medians.h"

#include "engine/refinement/refine_maps.h"
#include "engine/refinement/refinement.h"
#include "tests/engine/engine_test.h"

namespace vantage::filled_medians_test {

constexpr int kWidth = 60;
constexpr int kHeight = 50;

/// A dark disc of disparity 12 before a bright background of 3, noise of 20 grey levels over both.
bool is_disc(int x, int y) { return (x - 30) * (x - 30) + (y - 25) * (y - 25) < 15 * 15; }

Image<std::uint8_t> disc_image(int channels) {
  std::mt19937 random(9);
  Image<std::uint8_t> image(kWidth, kHeight, channels);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    for (int c = 0; c < channels; ++c) {
      image.at(x, y, c) = static_cast<std::uint8_t>((is_disc(x, y) ? 60 : 170) + random() % 20);
    }
  }
  return image;
}

/// The disc's map and what is unmatched in it: stretches about its left and right outline, in every
/// fourth row wider.
struct DiscMap {
  DisparityMap map{kWidth, kHeight};
  Mask unmatched{kWidth, kHeight};
};

DiscMap disc_map() {
  DiscMap result;
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    result.map.at(x, y) = is_disc(x, y) ? 12 : 3;
    const int reach = y % 4 == 0 ? 7 : 2;
    result.unmatched.at(x, y) = 0;
    for (int i = -reach; i <= reach; ++i) {
      if (x + i >= 0 && x + i + 1 < kWidth && is_disc(x + i, y) != is_disc(x + i + 1, y)) {
        result.unmatched.at(x, y) = 255;
      }
    }
  }
  return result;
}

int wrong(const DisparityMap& map) {
  int count = 0;
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    count += map.at(x, y) != (is_disc(x, y) ? 12 : 3) ? 1 : 0;
  }
  return count;
}

TEST(FilledMedians, RowsThatWereFilledAloneFollowTheOutlines) {
  const Photograph photograph{disc_image(3)};
  DiscMap disc = disc_map();
  fill_unmatched(disc.unmatched, Side::kLeft, Fill::kMedian, execution(), disc.map);
  const int before = wrong(disc.map);
  FilledMediansWork work;
  frame_photograph(photograph, execution(), work);
  take_filled_medians(disc.unmatched, {}, execution(), work, disc.map);
  EXPECT_GT(before, 100);
  EXPECT_LT(wrong(disc.map), before / 4);
}

TEST(FilledMedians, MatchedPixelsStayAndExecutionsAgree) {
  const Photograph photograph{disc_image(1)};
  const DiscMap disc = disc_map();
  DisparityMap noisy = disc.map.copy();
  std::mt19937 random(10);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    noisy.at(x, y) += static_cast<float>(random() % 64) / 16;
  }
  DisparityMap serial = noisy.copy();
  FilledMediansWork work;
  Execution one({.executor = scheduler::ExecutorKind::kSerial});
  frame_photograph(photograph, one, work);
  take_filled_medians(disc.unmatched, {}, one, work, serial);
  int changed = 0;
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    changed += serial.at(x, y) != noisy.at(x, y) ? 1 : 0;
    if (disc.unmatched.at(x, y) == 0) {
      ASSERT_EQ(serial.at(x, y), noisy.at(x, y)) << x << ", " << y;
    }
  }
  EXPECT_GT(changed, 100);
  Execution three({.threads = 3, .executor = scheduler::ExecutorKind::kOpenMp});
  frame_photograph(photograph, three, work);
  take_filled_medians(disc.unmatched, {}, three, work, noisy);
  EXPECT_TRUE(identical(serial, noisy));
}

TEST(FilledMedians, DepthsOfPhotographsAgree) {
  for (const int channels : {1, 4}) {
    const Image<std::uint8_t> bytes = disc_image(channels);
    Image<std::uint16_t> words(kWidth, kHeight, channels);
    Image<float> floats(kWidth, kHeight, channels);
    for (const auto [i, y] : positions_of(kWidth * channels, kHeight)) {
      words.row(y)[i] = static_cast<std::uint16_t>(bytes.row(y)[i] * 257 + 90);
      floats.row(y)[i] = (static_cast<float>(bytes.row(y)[i]) - 0.4F) / 255;
    }
    DiscMap disc = disc_map();
    fill_unmatched(disc.unmatched, Side::kRight, Fill::kMedian, execution(), disc.map);
    const auto filled = [&](const Photograph& photograph) {
      DisparityMap map = disc.map.copy();
      FilledMediansWork work;
      frame_photograph(photograph, execution(), work);
      take_filled_medians(disc.unmatched, {}, execution(), work, map);
      return map;
    };
    const DisparityMap expected = filled({bytes.copy()});
    EXPECT_TRUE(identical(filled({std::move(words)}), expected));
    EXPECT_TRUE(identical(filled({std::move(floats)}), expected));
  }
}

TEST(FilledMedians, RefinementTakesThemOfBothComponents) {
  const Photograph photograph{disc_image(3)};
  DiscMap disc = disc_map();
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    if (disc.unmatched.at(x, y) != 0) {
      disc.map.at(x, y) = std::nanf("");
    }
  }
  RefinementWork work;
  const auto refined = [&](Fill fill) {
    MatchedMap matched{.disparity_px = disc.map.copy(), .disparity_y_px = disc.map.copy()};
    const MapToRefine map{.side = Side::kLeft, .image = &photograph, .map = &matched};
    refine_maps({.cross_check = false, .fill = fill}, map, nullptr, execution(), work,
                [](std::string_view) {});
    EXPECT_TRUE(identical(matched.disparity_px, matched.disparity_y_px));
    return wrong(matched.disparity_px);
  };
  const int constant = refined(Fill::kConstant);
  EXPECT_GT(constant, 100);
  EXPECT_LT(refined(Fill::kMedian), constant / 4);
}

}  // namespace vantage::filled_medians_test
