#include "engine/refinement/filled_medians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string_view>
#include <utility>

#include "engine/refinement/refine_maps.h"
#include "engine/refinement/refinement.h"
#include "tests/engine/identical_maps.h"

namespace vantage {
namespace filled_medians_test {

constexpr int kWidth = 60;
constexpr int kHeight = 50;

/// A dark disc of disparity 12 before a bright background of 3, noise of 20 grey levels over both.
bool is_disc(int x, int y) { return (x - 30) * (x - 30) + (y - 25) * (y - 25) < 15 * 15; }

Image<std::uint8_t> disc_image(int channels) {
  std::mt19937 random(9);
  Image<std::uint8_t> image(kWidth, kHeight, channels);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>((is_disc(x, y) ? 60 : 170) + random() % 20);
      }
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
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      result.map.at(x, y) = is_disc(x, y) ? 12 : 3;
      const int reach = y % 4 == 0 ? 7 : 2;
      result.unmatched.at(x, y) = 0;
      for (int i = -reach; i <= reach; ++i) {
        if (x + i >= 0 && x + i + 1 < kWidth && is_disc(x + i, y) != is_disc(x + i + 1, y)) {
          result.unmatched.at(x, y) = 255;
        }
      }
    }
  }
  return result;
}

int wrong(const DisparityMap& map) {
  int count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      count += map.at(x, y) != (is_disc(x, y) ? 12 : 3) ? 1 : 0;
    }
  }
  return count;
}

TEST(FilledMedians, RowsThatWereFilledAloneFollowTheOutlines) {
  Execution execution({.threads = 2});
  const Photograph photograph{disc_image(3)};
  DiscMap disc = disc_map();
  fill_unmatched(disc.unmatched, Side::kLeft, Fill::kMedian, execution, disc.map);
  const int before = wrong(disc.map);
  FilledMediansWork work;
  take_filled_medians(disc.unmatched, photograph, {}, execution, work, disc.map);
  EXPECT_GT(before, 100);
  EXPECT_LT(wrong(disc.map), before / 4);
}

TEST(FilledMedians, MatchedPixelsStayAndExecutionsAgree) {
  const Photograph photograph{disc_image(1)};
  const DiscMap disc = disc_map();
  DisparityMap noisy = disc.map.copy();
  std::mt19937 random(10);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      noisy.at(x, y) += static_cast<float>(random() % 64) / 16;
    }
  }
  DisparityMap serial = noisy.copy();
  FilledMediansWork work;
  Execution one({.executor = scheduler::ExecutorKind::kSerial});
  take_filled_medians(disc.unmatched, photograph, {}, one, work, serial);
  int changed = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      changed += serial.at(x, y) != noisy.at(x, y) ? 1 : 0;
      if (disc.unmatched.at(x, y) == 0) {
        ASSERT_EQ(serial.at(x, y), noisy.at(x, y)) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(changed, 100);
  Execution three({.threads = 3, .executor = scheduler::ExecutorKind::kOpenMp});
  take_filled_medians(disc.unmatched, photograph, {}, three, work, noisy);
  EXPECT_TRUE(test::identical(serial, noisy));
}

TEST(FilledMedians, DepthsOfPhotographsAgree) {
  Execution execution({.threads = 2});
  for (const int channels : {1, 4}) {
    const Image<std::uint8_t> bytes = disc_image(channels);
    Image<std::uint16_t> words(kWidth, kHeight, channels);
    Image<float> floats(kWidth, kHeight, channels);
    for (int y = 0; y < kHeight; ++y) {
      for (int i = 0; i < kWidth * channels; ++i) {
        words.row(y)[i] = static_cast<std::uint16_t>(bytes.row(y)[i] * 257 + 90);
        floats.row(y)[i] = (static_cast<float>(bytes.row(y)[i]) - 0.4F) / 255;
      }
    }
    DiscMap disc = disc_map();
    fill_unmatched(disc.unmatched, Side::kRight, Fill::kMedian, execution, disc.map);
    const auto filled = [&](const Photograph& photograph) {
      DisparityMap map = disc.map.copy();
      FilledMediansWork work;
      take_filled_medians(disc.unmatched, photograph, {}, execution, work, map);
      return map;
    };
    const DisparityMap expected = filled({bytes.copy()});
    EXPECT_TRUE(test::identical(filled({std::move(words)}), expected));
    EXPECT_TRUE(test::identical(filled({std::move(floats)}), expected));
  }
}

TEST(FilledMedians, RefinementTakesThemOfBothComponents) {
  Execution execution({.threads = 2});
  const Photograph photograph{disc_image(3)};
  DiscMap disc = disc_map();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (disc.unmatched.at(x, y) != 0) {
        disc.map.at(x, y) = std::nanf("");
      }
    }
  }
  RefinementWork work;
  const auto refined = [&](Fill fill) {
    MatchedMap matched{.disparity_px = disc.map.copy(), .disparity_y_px = disc.map.copy()};
    const MapToRefine map{.side = Side::kLeft, .image = &photograph, .map = &matched};
    refine_maps({.edge_snapping_px = 0,
                 .cross_check = false,
                 .cross_check_px = 1,
                 .cross_check_level = 0,
                 .confidence_threshold = -std::numeric_limits<double>::infinity(),
                 .speckle_size_px = 0,
                 .surface_fit_px = 0,
                 .surface_fit_step_px = 1,
                 .fill = fill},
                map, nullptr, execution, work, [](std::string_view) {});
    EXPECT_TRUE(test::identical(matched.disparity_px, matched.disparity_y_px));
    return wrong(matched.disparity_px);
  };
  const int constant = refined(Fill::kConstant);
  EXPECT_GT(constant, 100);
  EXPECT_LT(refined(Fill::kMedian), constant / 4);
}

}  // namespace filled_medians_test
}  // namespace vantage
