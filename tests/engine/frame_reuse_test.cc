#include "engine/sequence/past/frame_reuse.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"

namespace vantage::frame_reuse_test {

using Bytes = Image<std::uint8_t>;

constexpr int kWidth = 320;
constexpr int kHeight = 192;
constexpr int kFar = 6;
constexpr int kNear = 18;
constexpr int kFrames = 16;  // after which each tile was searched again

struct Pair {
  Photograph left;
  Photograph right;
};

/// A textured wall, and in front of it a square of 48 pixels at (square_x, 70); none: below 0.
Pair pair_with_square(int square_x, unsigned seed = 1) {
  std::mt19937 random(seed);
  const auto texture = [&random] {
    Bytes image(kWidth + 100, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      float value = 128;
      for (int x = 0; x < image.width(); ++x) {
        value = 0.5F * value + 0.5F * static_cast<float>(random() % 256);
        image.at(x, y) = static_cast<std::uint8_t>(value);
      }
    }
    return image;
  };
  const Bytes wall = texture();
  const Bytes square = texture();
  const auto view = [&](int shift_of_wall, int shift_of_square) {
    Bytes image(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const int u = x + shift_of_square - square_x;
      const bool is_near = square_x >= 0 && u >= 0 && u < 48 && y >= 70 && y < 118;
      image.at(x, y) = is_near ? square.at(u, y) : wall.at(x + shift_of_wall, y);
    }
    return Photograph{std::move(image)};
  };
  return {view(0, 0), view(kFar, kNear)};
}

class FrameReuseTest : public ::testing::TestWithParam<MatchPreset> {
 protected:
  static MatchOptions options() {
    MatchOptions options;
    options.preset = GetParam();
    options.disparities = {0, 31};
    return options;
  }
  DisparityMaps match(const Pair& pair, bool reuses, bool with_right = true) {
    DisparityMaps maps;
    matcher_.match(pair.left, pair.right,
                   {.right = with_right, .previous = reuses ? &reuse_ : nullptr}, maps, &report_);
    return maps;
  }
  DisparityMaps next(const Pair& pair, bool with_right = true) {
    reuse_.start_frame(frame_, frame_ == 0);
    ++frame_;
    return match(pair, true, with_right);
  }
  /// Share of the pixels of the left map, borders aside, within a pixel of the truth.
  static double share_right(const DisparityMap& map, int square_x) {
    int right = 0;
    int all = 0;
    for (const auto [x, y] : positions_of({40, kWidth - 8}, {8, kHeight - 8})) {
      const bool is_near = x >= square_x && x < square_x + 48 && y >= 70 && y < 118;
      const bool is_hidden =
          !is_near && x >= square_x - kNear && x < square_x && y >= 70 && y < 118;
      if (!is_hidden) {
        ++all;
        const int truth = is_near ? kNear : kFar;
        right += std::abs(map.at(x, y) - static_cast<float>(truth)) < 1 ? 1 : 0;
      }
    }
    return static_cast<double>(right) / all;
  }

  Execution execution_{{.threads = 2}};
  StereoMatcher matcher_{options(), execution_};
  FrameReuse reuse_{3, execution_};
  MatchReport report_;
  int frame_ = 0;
};

TEST_P(FrameReuseTest, TheFirstFrameIsSearchedAndUnchangedOnesStay) {
  const Pair pair = pair_with_square(120);
  const DisparityMaps expected = match(pair, false);
  EXPECT_FALSE(report_.searched_share);
  for (int frame = 0; frame <= kFrames; ++frame) {
    const DisparityMaps maps = next(pair);
    EXPECT_TRUE(identical(maps, expected)) << frame;
    EXPECT_TRUE(identical(maps.left.unmatched, expected.left.unmatched)) << frame;
    if (frame == 0) {
      EXPECT_EQ(report_.searched_share, 1);
    } else {
      EXPECT_LT(*report_.searched_share, 0.3) << frame;
    }
  }
}

TEST_P(FrameReuseTest, WhatMovesAppearsAndDisappearsIsSearched) {
  next(pair_with_square(-1));
  for (const int square_x : {100, 103, 110, 190, 60}) {
    const Pair pair = pair_with_square(square_x);
    const double without = share_right(match(pair, false).left.disparity_px, square_x);
    const double with = share_right(next(pair).left.disparity_px, square_x);
    EXPECT_LT(*report_.searched_share, 0.5);
    EXPECT_GT(with, without - 0.003) << square_x;
  }
  const Pair empty = pair_with_square(-1);
  EXPECT_GT(share_right(next(empty).left.disparity_px, -100), 0.995);
}

/// What is alike in the lower third is so by chance.
TEST_P(FrameReuseTest, AfterACutAllIsSearched) {
  const Pair before = pair_with_square(100);
  next(before);
  Pair after = pair_with_square(100, 7);
  for (int y = 2 * kHeight / 3; y < kHeight; ++y) {
    std::copy_n(std::get<Bytes>(before.left.pixels).row(y), kWidth,
                std::get<Bytes>(after.left.pixels).row(y));
    std::copy_n(std::get<Bytes>(before.right.pixels).row(y), kWidth,
                std::get<Bytes>(after.right.pixels).row(y));
  }
  const DisparityMaps maps = next(after);
  EXPECT_EQ(report_.searched_share, 1);
  const DisparityMaps expected = match(after, false);
  EXPECT_TRUE(identical(maps, expected));
  // Its maps were not kept, those of the next frame are.
  EXPECT_TRUE(identical(next(after), expected));
  EXPECT_EQ(report_.searched_share, 1);
  EXPECT_TRUE(identical(next(after), expected));
  EXPECT_LT(*report_.searched_share, 0.3);
}

TEST_P(FrameReuseTest, PairsThatMovedCanBeMatchedLater) {
  const auto look = [&](const Pair& pair, DeferredMatch& deferred, DisparityMaps& maps) {
    reuse_.start_frame(frame_, frame_ == 0);
    ++frame_;
    matcher_.match(pair.left, pair.right, {.previous = &reuse_, .deferred = &deferred}, maps,
                   &report_);
  };
  const Pair before = pair_with_square(100);
  const Pair moved = pair_with_square(100, 7);
  const Pair after = pair_with_square(100, 8);
  DisparityMaps maps;
  DeferredMatch none;
  look(before, none, maps);
  EXPECT_FALSE(none.is_pending);
  EXPECT_TRUE(identical(maps, match(before, false)));
  DisparityMaps maps_of_moved;
  DeferredMatch deferred;
  look(moved, deferred, maps_of_moved);
  EXPECT_TRUE(deferred.is_pending);
  EXPECT_TRUE(maps_of_moved.left.disparity_px.empty());
  MatchReport report = report_;
  DeferredMatch deferred_after;
  look(after, deferred_after, maps);
  EXPECT_TRUE(deferred_after.is_pending);
  look(after, none, maps);
  EXPECT_FALSE(none.is_pending) << "does not move";
  EXPECT_TRUE(identical(maps, match(after, false)));
  matcher_.match(moved.left, moved.right, {.deferred = &deferred}, maps_of_moved, &report);
  EXPECT_FALSE(deferred.is_pending);
  EXPECT_EQ(report.searched_share, 1);
  EXPECT_TRUE(identical(maps_of_moved, match(moved, false)));
  EXPECT_TRUE(identical(next(after), match(after, false)));
  EXPECT_LT(*report_.searched_share, 0.3) << "kept the maps of the frame before";
}

TEST_P(FrameReuseTest, TilesWhosePartnersChangedAreSearched) {
  Pair pair = pair_with_square(-1);
  next(pair);
  const auto& searched = reuse_.of(Side::kLeft).searched;
  constexpr int kTilePx = 2 * TileMask::kSidePx;
  for (const auto [x, y] : positions_of({170, 190}, {70, 118})) {
    std::get<Bytes>(pair.right.pixels).at(x, y) = static_cast<std::uint8_t>(x * y % 251);
  }
  next(pair);
  EXPECT_TRUE(searched.at((180 + kFar) / kTilePx, 90 / kTilePx));
  EXPECT_FALSE(searched.at((180 + 90) / kTilePx, 90 / kTilePx));
}

/// Each frame differs from the one before by less than the threshold.
TEST_P(FrameReuseTest, SlowChangesAddUp) {
  const auto brighter = [](Pair pair, int levels) {
    for (Photograph* photograph : {&pair.left, &pair.right}) {
      auto& image = std::get<Bytes>(photograph->pixels);
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        image.at(x, y) = static_cast<std::uint8_t>(std::min(255, image.at(x, y) + levels));
      }
    }
    return pair;
  };
  next(pair_with_square(100));
  bool was_searched = false;
  for (int frame = 1; frame <= 4; ++frame) {
    next(brighter(pair_with_square(100), 2 * frame));
    was_searched = was_searched || report_.searched_share == 1;
  }
  EXPECT_TRUE(was_searched);
}

TEST_P(FrameReuseTest, EachTileIsSearchedOnceInSixteenFrames) {
  const Pair pair = pair_with_square(100);
  next(pair);
  double sum = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    next(pair);
    sum += reuse_.of(Side::kLeft).searched.share();
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST_P(FrameReuseTest, ImagesOfAnotherSizeAndOtherMapsStartAgain) {
  next(pair_with_square(100));
  const auto lower_half = [](const Photograph& photograph) {
    Bytes half(kWidth, kHeight / 2);
    for (int y = 0; y < half.height(); ++y) {
      std::copy_n(std::get<Bytes>(photograph.pixels).row(y + kHeight / 2), kWidth, half.row(y));
    }
    return Photograph{std::move(half)};
  };
  const Pair whole = pair_with_square(100);
  const Pair half{lower_half(whole.left), lower_half(whole.right)};
  EXPECT_TRUE(identical(next(half), match(half, false)));
  EXPECT_TRUE(identical(next(whole), match(whole, false)));
}

TEST_P(FrameReuseTest, ResultsDoNotDependOnTheExecution) {
  const auto maps_of = [](const ExecutionOptions& how) {
    Execution execution(how);
    MatchOptions used = options();
    if (GetParam() == MatchPreset::kRealtime) {
      used.parameters.search_size = SearchSize::kQuarter;
    }
    const StereoMatcher matcher(used, execution);
    FrameReuse reuse(3, execution);
    DisparityMaps maps;
    for (int frame = 0; frame < 4; ++frame) {
      const Pair pair = pair_with_square(100 + 2 * frame);
      reuse.start_frame(frame, frame == 0);
      matcher.match(pair.left, pair.right, {.confidence = true, .previous = &reuse}, maps);
    }
    return maps;
  };
  const DisparityMaps expected =
      maps_of({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  EXPECT_TRUE(identical(maps_of({.threads = 3}), expected));
  EXPECT_TRUE(
      identical(maps_of({.threads = 2, .strip_width_px = 11, .band_height_px = 5}), expected));
  // Whose levels would be in bands without frames before.
  EXPECT_TRUE(identical(maps_of({.threads = 2, .level_memory_bytes = 1}), expected));
}

TEST_P(FrameReuseTest, TheLeftMapAloneStaysToo) {
  const Pair pair = pair_with_square(120);
  const DisparityMap expected = match(pair, false, false).left.disparity_px.copy();
  for (int frame = 0; frame <= kFrames; ++frame) {
    EXPECT_TRUE(identical(next(pair, false).left.disparity_px, expected)) << frame;
  }
  const DisparityMaps both = match(pair, false);
  EXPECT_TRUE(identical(next(pair), both));
  EXPECT_EQ(report_.searched_share, 1);
}

INSTANTIATE_TEST_SUITE_P(Presets, FrameReuseTest,
                         ::testing::Values(MatchPreset::kRealtime, MatchPreset::kBalanced));

TEST(FrameReuse, RefusesMethodsWithoutCoarseLevels) {
  const Pair pair = pair_with_square(120);
  FrameReuse reuse(3, execution());
  const auto match = [&](MatchMethod method) {
    MatchOptions options;
    options.method = method;
    options.disparities = {0, 3};
    DisparityMaps maps;
    StereoMatcher(options, execution()).match(pair.left, pair.right, {.previous = &reuse}, maps);
  };
  EXPECT_THROW(match(MatchMethod::kSsd), UsageError);
  EXPECT_THROW(match(MatchMethod::kBayes), UsageError);
}

TEST(FrameReuse, RefusesThresholdsOutsideGreyLevels) {
  EXPECT_THROW(FrameReuse(-1, execution()), UsageError);
}

}  // namespace vantage::frame_reuse_test
