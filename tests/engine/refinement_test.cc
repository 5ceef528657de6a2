#include "engine/refinement/refinement.h"

#include "engine/refinement/refine_maps.h"
#include "tests/engine/engine_test.h"

namespace vantage::refinement_test {

DisparityMap map_of(const std::vector<std::vector<float>>& rows) {
  DisparityMap map(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < map.height(); ++y) {
    std::copy(rows[static_cast<std::size_t>(y)].begin(), rows[static_cast<std::size_t>(y)].end(),
              map.row(y));
  }
  return map;
}

template <typename T>
std::vector<std::vector<T>> rows_of(const Image<T>& image) {
  std::vector<std::vector<T>> rows;
  for (int y = 0; y < image.height(); ++y) {
    rows.emplace_back(image.row(y), image.row(y) + image.width());
  }
  return rows;
}

using Rows = std::vector<std::vector<float>>;
using MaskRows = std::vector<std::vector<std::uint8_t>>;

TEST(MarkUnsure, MarksWhatIsNotAboveTheThresholdBesideWhatIsMarked) {
  const DisparityMap confidence = map_of({{-1, 0, 0.5F}, {kUnknown, 2, 3}});
  const auto marked = [&](double threshold) {
    Mask mask(3, 2);
    mask.fill(0);
    mask.at(2, 1) = 255;
    mark_unsure(confidence.view(), threshold, execution(), mask);
    return rows_of(mask);
  };
  EXPECT_EQ(marked(0), (MaskRows{{255, 255, 0}, {255, 0, 255}}));
  EXPECT_EQ(marked(0.5), (MaskRows{{255, 255, 255}, {255, 0, 255}}));
  EXPECT_EQ(marked(-2), (MaskRows{{0, 0, 0}, {255, 0, 255}}));
}

TEST(Fill, ConstantLinearAndNone) {
  Mask unmatched(5, 3);
  unmatched.fill(255);
  for (const int x : {0, 4}) {
    unmatched.at(x, 1) = 0;
  }
  const auto filled = [&](Fill fill, Side side, float right) {
    DisparityMap map = map_of({{9, 9, 9, 9, 9}, {4, kUnknown, 9, 9, right}, {8, 8, 8, 8, 8}});
    fill_unmatched(unmatched, side, fill, execution(), map);
    return map;
  };
  const std::vector<float> line = {4, 4.25F, 4.5F, 4.75F, 5};
  EXPECT_EQ(rows_of(filled(Fill::kLinear, Side::kLeft, 5)), (Rows{line, line, line}));
  const std::vector<float> left = {4, 4, 4, 4, 6};
  const std::vector<float> right = {4, 6, 6, 6, 6};
  for (const Fill fill : {Fill::kConstant, Fill::kLinear}) {
    EXPECT_EQ(rows_of(filled(fill, Side::kLeft, 6)), (Rows{left, left, left}));
    EXPECT_EQ(rows_of(filled(fill, Side::kRight, 6)), (Rows{right, right, right}));
  }
  const DisparityMap none = filled(Fill::kNone, Side::kLeft, 6);
  for (const auto [x, y] : positions_of(5, 3)) {
    EXPECT_EQ(std::isnan(none.at(x, y)), unmatched.at(x, y) != 0);
  }
  EXPECT_EQ(none.at(4, 1), 6);
}

TEST(CrossCheckOfTwoComponents, EqualsPlainTranscription) {
  std::mt19937 random(8);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {13, 11}, {31, 23}}) {
    for (const double tolerance_px : {1.0, 1.5, 3.0}) {
      const auto noise = [&, w = width, h = height](int low, int high) {
        DisparityMap map(w, h);
        for (const auto [x, y] : positions_of(w, h)) {
          map.at(x, y) =
              random() % 8 == 0
                  ? kUnknown
                  : static_cast<float>(low) +
                        static_cast<float>(random() % static_cast<unsigned>(2 * (high - low) + 1)) /
                            2;
        }
        return map;
      };
      const DisparityMap left_x = noise(0, 3);
      const DisparityMap left_y = noise(-1, 2);
      const DisparityMap right_x = noise(0, 3);
      const DisparityMap right_y = noise(-1, 2);
      Mask left;
      Mask right;
      const DisplacementView of_left{left_x.view(), left_y.view()};
      const DisplacementView of_right{right_x.view(), right_y.view()};
      cross_check(of_left, of_right, Side::kLeft, tolerance_px, execution(), left);
      cross_check(of_right, of_left, Side::kRight, tolerance_px, execution(), right);
      const auto agrees = [&, w = width, h = height](int x, int y, bool is_left) {
        const double dx = (is_left ? left_x : right_x).at(x, y);
        const double dy = (is_left ? left_y : right_y).at(x, y);
        if (std::isnan(dx) || std::isnan(dy)) {
          return false;
        }
        const auto u = static_cast<int>(std::floor(is_left ? x - dx + 0.5 : x + dx + 0.5));
        const auto v = static_cast<int>(std::floor(is_left ? y - dy + 0.5 : y + dy + 0.5));
        if (u < 0 || v < 0 || u >= w || v >= h) {
          return false;
        }
        const double back_x = (is_left ? right_x : left_x).at(u, v);
        const double back_y = (is_left ? right_y : left_y).at(u, v);
        return !std::isnan(back_x) && !std::isnan(back_y) && std::abs(dx - back_x) < tolerance_px &&
               std::abs(dy - back_y) < tolerance_px;
      };
      for (const auto [x, y] : positions_of(width, height)) {
        ASSERT_EQ(left.at(x, y), agrees(x, y, true) ? 0 : 255) << x << ", " << y;
        ASSERT_EQ(right.at(x, y), agrees(x, y, false) ? 0 : 255) << x << ", " << y;
      }
    }
  }
}

/// A pair of one-row maps and what refinement makes of them.
struct RefinementCase {
  RefinementOptions options{.fill = Fill::kNone};
  MatchedMap left{.disparity_px = map_of({{0, 0, 0, 0, 2, 2, 2, 0, 0, 0}}),
                  .confidence = map_of({{5, 4, 3, 2, 1, 0, -1, -2, kUnknown, 9}})};
  MatchedMap right{.disparity_px = map_of({{0, 0, 2, 2, 2, 0, 0, 0, 0, 0}}),
                   .confidence = map_of({{1, 1, 1, 1, 1, 1, 1, 1, 1, 1}})};
  bool left_is_result = true;
  bool right_is_result = true;
  std::vector<std::string> steps;

  void refine(bool both = true) {
    RefinementWork work;
    const MapToRefine left_map{.side = Side::kLeft, .map = &left, .is_result = left_is_result};
    const MapToRefine right_map{.side = Side::kRight, .map = &right, .is_result = right_is_result};
    refine_maps(options, left_map, both ? &right_map : nullptr, execution(), work,
                [&](std::string_view step) { steps.emplace_back(step); });
  }
  [[nodiscard]] std::vector<std::uint8_t> left_mask() const { return rows_of(left.unmatched)[0]; }
  [[nodiscard]] std::vector<std::uint8_t> right_mask() const { return rows_of(right.unmatched)[0]; }
};

TEST(RefineMaps, AMapThatIsNoResultIsLeftAlone) {
  for (const bool left_is_result : {true, false}) {
    RefinementCase both;
    both.options.fill = Fill::kConstant;
    both.options.speckle_size_px = 2;
    both.refine();
    RefinementCase one;
    one.options = both.options;
    (left_is_result ? one.right_is_result : one.left_is_result) = false;
    one.refine();
    const RefinementCase untouched;
    EXPECT_TRUE(
        identical(one.left.disparity_px, (left_is_result ? both : untouched).left.disparity_px));
    EXPECT_TRUE(
        identical(one.right.disparity_px, (left_is_result ? untouched : both).right.disparity_px));
    const auto mask = [&](const RefinementCase& of) {
      return left_is_result ? of.left_mask() : of.right_mask();
    };
    EXPECT_EQ(mask(one), mask(both));
  }
}

TEST(RefineMaps, CrossCheckMarksWhatIsHiddenInTheOtherImage) {
  RefinementCase pair;
  pair.refine();
  // Columns 2, 3 of the left image are hidden behind the square in the right one, 5 and 6 there.
  EXPECT_THAT(pair.left_mask(), ElementsAre(0, 0, 255, 255, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(pair.right_mask(), ElementsAre(0, 0, 0, 0, 0, 255, 255, 0, 0, 0));
  EXPECT_THAT(pair.steps, ElementsAre("cross-check", "fill"));
  EXPECT_TRUE(std::isnan(pair.left.disparity_px.at(2, 0)));
  EXPECT_EQ(pair.left.disparity_px.at(4, 0), 2);
}

TEST(RefineMaps, EachStepCanBeSwitched) {
  RefinementCase none;
  none.options.cross_check = false;
  none.left.disparity_px.at(7, 0) = kUnknown;
  none.refine();
  EXPECT_THAT(none.left_mask(), ElementsAre(0, 0, 0, 0, 0, 0, 0, 255, 0, 0));
  EXPECT_THAT(none.steps, ElementsAre("fill"));

  RefinementCase confidence;
  confidence.options.cross_check = false;
  confidence.options.confidence_threshold = 0;
  confidence.refine();
  EXPECT_THAT(confidence.left_mask(), ElementsAre(0, 0, 0, 0, 0, 255, 255, 255, 255, 0));
  EXPECT_THAT(confidence.right_mask(), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(confidence.steps, ElementsAre("confidence", "fill"));

  RefinementCase all;
  all.options.confidence_threshold = 0;
  all.options.speckle_size_px = 2;
  all.options.fill = Fill::kConstant;
  all.refine();
  // After cross-check and confidence columns 0, 1, 4 and 9 are left; 4 and 9 are alone.
  EXPECT_THAT(all.left_mask(), ElementsAre(0, 0, 255, 255, 255, 255, 255, 255, 255, 255));
  EXPECT_THAT(all.steps, ElementsAre("cross-check", "confidence", "speckles", "fill"));
  EXPECT_EQ(rows_of(all.left.disparity_px), (Rows{std::vector<float>(10, 0)}));
}

TEST(RefineMaps, AMapWithoutPartnerHasNoCrossCheck) {
  RefinementCase alone;
  alone.left.disparity_px.at(0, 0) = kUnknown;
  alone.options.fill = Fill::kConstant;
  alone.refine(false);
  EXPECT_THAT(alone.left_mask(), ElementsAre(255, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(alone.left.disparity_px.at(0, 0), 0);
  EXPECT_TRUE(alone.right.unmatched.empty());
  EXPECT_THAT(alone.steps, ElementsAre("fill"));
}

TEST(RefineMaps, EdgesOfEachImageMoveItsOwnMapBeforeTheCrossCheck) {
  // A surface of disparity 4 before the background 0, its border at an intensity edge in both
  // images; both maps put it elsewhere.
  constexpr int kWidth = 40;
  constexpr int kHeight = 9;
  const auto image = [](int first) {
    Image<std::uint8_t> pixels(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      pixels.at(x, y) = x < first ? 30 : 220;
    }
    return Photograph{std::move(pixels)};
  };
  const auto map = [](int first) {
    DisparityMap result(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      result.at(x, y) = x < first ? 0.0F : 4.0F;
    }
    return result;
  };
  const Photograph left_image = image(24);
  const Photograph right_image = image(20);
  RefinementCase pair;
  pair.options.edge_snapping_px = 4;
  pair.options.fill = Fill::kConstant;
  pair.left.disparity_px = map(27);
  pair.right.disparity_px = map(17);
  RefinementWork work;
  const MapToRefine left_map{.side = Side::kLeft, .image = &left_image, .map = &pair.left};
  const MapToRefine right_map{.side = Side::kRight, .image = &right_image, .map = &pair.right};
  std::vector<std::string> steps;
  refine_maps(pair.options, right_map, &left_map, execution(), work,
              [&](std::string_view step) { steps.emplace_back(step); });
  EXPECT_THAT(steps, ElementsAre("edge snapping", "cross-check", "fill"));
  for (int y = 0; y < kHeight; ++y) {
    // Up to the edge pixel itself, on either side of which the border may be.
    EXPECT_EQ(pair.left.disparity_px.at(22, y), 0);
    EXPECT_EQ(pair.left.disparity_px.at(25, y), 4);
    EXPECT_EQ(pair.right.disparity_px.at(18, y), 0);
    EXPECT_EQ(pair.right.disparity_px.at(21, y), 4);
    EXPECT_EQ(pair.left.unmatched.at(26, y), 0);
    // The right image shows the partners of the left one's last columns, but not the reverse.
    EXPECT_EQ(pair.left.unmatched.at(39, y), 0);
    EXPECT_EQ(pair.right.unmatched.at(39, y), 255);
  }
}

TEST(RefineMaps, BothComponentsAreCheckedAndFilledTogether) {
  MatchedMap left{.disparity_px = map_of({{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}}),
                  .disparity_y_px = map_of({{-1, -1, -1, -1}, {-1, 0, -1, -1}, {-1, -1, -1, -1}})};
  MatchedMap right{.disparity_px = left.disparity_px.copy(), .disparity_y_px = DisparityMap(4, 3)};
  right.disparity_y_px.fill(-1);
  RefinementCase defaults;
  defaults.options.fill = Fill::kConstant;
  RefinementWork work;
  const MapToRefine left_map{.side = Side::kLeft, .map = &left};
  const MapToRefine right_map{.side = Side::kRight, .map = &right};
  refine_maps(defaults.options, left_map, &right_map, execution(), work, [](std::string_view) {});
  // The partner of (x, y) is (x − 1, y + 1): the first column and the last row have none.
  EXPECT_EQ(rows_of(left.unmatched),
            (MaskRows{{255, 0, 0, 0}, {255, 255, 0, 0}, {255, 255, 255, 255}}));
  EXPECT_EQ(rows_of(right.unmatched),
            (MaskRows{{255, 255, 255, 255}, {0, 0, 0, 255}, {255, 0, 0, 255}}));
  EXPECT_EQ(left.disparity_y_px.at(1, 1), -1);
  EXPECT_EQ(left.disparity_y_px.at(0, 0), -1);
}

}  // namespace vantage::refinement_test
