#include "engine/image/left_out.h"

#include "engine/matching/stereo_matcher.h"
#include "engine/matching/unrectified_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/random_grey.h"
#include "tests/engine/unrectified_pair.h"

namespace vantage::left_out_test {

/// 255 in a rectangle, 0 elsewhere.
Mask rectangle(int width, int height, int first_x, int end_x, int first_y, int end_y) {
  Mask mask(width, height);
  mask.fill(0);
  for (const auto [x, y] : positions_of({first_x, end_x}, {first_y, end_y})) {
    mask.at(x, y) = 255;
  }
  return mask;
}

const Image<std::uint8_t>& bytes(const Photograph& photograph) {
  return std::get<Image<std::uint8_t>>(photograph.pixels);
}

TEST(LeaveOut, TakesTheNearestPixelOfTheRowElseTheNearestRow) {
  Image<std::uint8_t> image(6, 4);
  for (const auto [x, y] : positions_of(6, 4)) {
    image.at(x, y) = static_cast<std::uint8_t>(10 * y + x);
  }
  Photograph photograph{std::move(image)};
  Mask mask = rectangle(6, 4, 1, 5, 2, 3);
  for (int x = 0; x < 6; ++x) {
    mask.at(x, 0) = 255;
    mask.at(x, 3) = x < 4 ? 255 : 0;
  }
  leave_out(photograph, std::move(mask));
  const auto row = [&](int y) {
    return std::vector<int>(bytes(photograph).row(y), bytes(photograph).row(y) + 6);
  };
  EXPECT_THAT(row(0), testing::ElementsAre(10, 11, 12, 13, 14, 15));
  EXPECT_THAT(row(1), testing::ElementsAre(10, 11, 12, 13, 14, 15));
  EXPECT_THAT(row(2), testing::ElementsAre(20, 20, 20, 25, 25, 25));
  EXPECT_THAT(row(3), testing::ElementsAre(34, 34, 34, 34, 34, 35));
}

constexpr int kWidth = 150;
constexpr int kHeight = 80;
constexpr int kShiftPx = 7;

/// Smooth texture; the right image sees it kShiftPx further left.
Photograph seen_from(int place) {
  Image<std::uint8_t> image(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const double at = x + kShiftPx * place;
    const double value = std::sin(at * 0.9 + y * 0.31) + std::sin(at * 0.43 - y * 0.73) +
                         std::sin(at * 0.21 + y * 0.11);
    image.at(x, y) = static_cast<std::uint8_t>(std::lround(127 + 40 * value));
  }
  return {std::move(image)};
}

void expect_unknown_exactly_where(const Mask& left_out, const MatchedMap& map) {
  for (const auto [x, y] : positions_of(left_out.width(), left_out.height())) {
    const bool is_left_out = left_out.at(x, y) != 0;
    ASSERT_EQ(std::isnan(map.disparity_px.at(x, y)), is_left_out) << x << ", " << y;
    ASSERT_TRUE(map.unmatched.at(x, y) == 255 || !is_left_out) << x << ", " << y;
    ASSERT_TRUE(map.confidence.empty() || !is_left_out || map.confidence.at(x, y) == 0);
  }
}

struct Case {
  const char* name;
  MatchOptions options;
};

std::vector<Case> all_searches() {
  std::vector<Case> cases;
  const auto add = [&](const char* name, const auto& change) {
    MatchOptions options;
    options.disparities = {0, 15};
    change(options);
    cases.push_back({name, options});
  };
  add("windows", [](MatchOptions& o) { o.method = MatchMethod::kSsd; });
  add("coarse to fine", [](MatchOptions& o) { o.preset = MatchPreset::kBalanced; });
  add("reduced", [](MatchOptions& o) { o.preset = MatchPreset::kRealtime; });
  add("symmetric", [](MatchOptions& o) {
    o.method = MatchMethod::kBayes;
    o.parameters.selection = Selection::kSymmetric;
  });
  add("half the size", [](MatchOptions& o) {
    o.preset = MatchPreset::kBalanced;
    o.scale = 0.5;
  });
  return cases;
}

TEST(LeftOut, IsUnknownAndItsPartnersAreUnmatchedInEverySearch) {
  Photograph left = seen_from(0);
  Photograph right = seen_from(1);
  leave_out(left, rectangle(kWidth, kHeight, 40, 60, 30, 60));
  leave_out(right, rectangle(kWidth, kHeight, 90, 110, 30, 60));
  for (const Case& one : all_searches()) {
    SCOPED_TRACE(one.name);
    DisparityMaps maps;
    MatchReport report;
    StereoMatcher(one.options).match(left, right, {.confidence = true}, maps, &report);
    expect_unknown_exactly_where(left.left_out, maps.left);
    expect_unknown_exactly_where(right.left_out, maps.right);
    int unmatched = 0;
    int right_disparities = 0;
    for (const auto [x, y] : positions_of({94 + kShiftPx, 106 + kShiftPx}, {34, 56})) {
      unmatched += maps.left.unmatched.at(x, y) != 0 ? 1 : 0;
    }
    for (const auto [x, y] : positions_of({10, 150}, {0, 80})) {
      right_disparities += std::abs(maps.left.disparity_px.at(x, y) - kShiftPx) < 1 ? 1 : 0;
    }
    EXPECT_GT(unmatched, 0.95 * 12 * 22);
    EXPECT_GT(right_disparities, 0.97 * (140 * 80 - 20 * 30));
    ASSERT_EQ(report.remarks.size(), 1);
    EXPECT_EQ(report.remarks[0].text,
              "region: 5 % of the left image, 5 % of the right image is not scene; left out");
  }
}

TEST(LeftOut, OfSeveralImagesAndAlongEpipolarLines) {
  Photograph reference = seen_from(0);
  Photograph right = seen_from(1);
  leave_out(reference, rectangle(kWidth, kHeight, 40, 60, 30, 60));
  leave_out(right, rectangle(kWidth, kHeight, 90, 110, 30, 60));
  MatchOptions options;
  options.disparities = {0, 15};
  const std::array<OtherView, 1> others = {OtherView{&right, 1}};
  DisparityMaps maps;
  StereoMatcher(options).match_several(reference, others, {}, maps);
  expect_unknown_exactly_where(reference.left_out, maps.left);
  EXPECT_EQ(maps.left.unmatched.at(100 + kShiftPx, 45), 255);

  RenderedPair pair = unrectified_pair(default_execution(), 160, 120);
  leave_out(pair.left, rectangle(160, 120, 60, 80, 40, 70));
  leave_out(pair.right, rectangle(160, 120, 90, 110, 40, 70));
  const Rectifier rectifier(pair.calibration, 160, 120);
  UnrectifiedMatcher(options, rectifier, default_execution())
      .match(pair.left, pair.right, {}, maps);
  expect_unknown_exactly_where(pair.left.left_out, maps.left);
  expect_unknown_exactly_where(pair.right.left_out, maps.right);
}

TEST(Rectifier, LeavesOutWhatItHasNotSeenAndWhatThePhotographLeavesOut) {
  RenderedPair pair = unrectified_pair(default_execution(), 160, 120);
  leave_out(pair.left, rectangle(160, 120, 60, 80, 40, 70));
  const Rectifier rectifier(pair.calibration, 160, 120, {.kept_outline = 1});
  Photograph rectified;
  rectifier.apply(pair.left, Side::kLeft, rectified, default_execution());
  int outside = 0;
  for (const auto [x, y] : positions_of(160, 120)) {
    const auto at = rectifier.source_position(Side::kLeft, {x, y});
    ASSERT_TRUE(at);
    const double column = std::floor(at->x() + 0.5);
    const double row = std::floor(at->y() + 0.5);
    const bool is_outside = column < 0 || column >= 160 || row < 0 || row >= 120;
    const bool is_masked = column >= 60 && column < 80 && row >= 40 && row < 70;
    outside += is_outside ? 1 : 0;
    ASSERT_EQ(rectified.left_out.at(x, y) != 0, is_outside || is_masked) << x << ", " << y;
  }
  EXPECT_GT(outside, 100);
  blacken_left_out(rectified);
  EXPECT_EQ(bytes(rectified).at(0, 0), 0);
}

}  // namespace vantage::left_out_test
