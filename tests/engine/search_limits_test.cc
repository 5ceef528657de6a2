

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/test_sample.h"

namespace vantage::search_limits_test {

constexpr int kWidth = 67;
constexpr int kHeight = 45;
constexpr DisparityRange kSearch{1, 6};
constexpr DisparityRange kSearchY{-1, 1};

/// A slanted surface whose disparities go from −3 to 10, beyond both ends of the search, and by
/// which rows are 0.3 rows off.
struct SlantedPair {
  Photograph left;
  Photograph right;
};

SlantedPair slanted_pair() {
  std::mt19937 random(7);
  // Texture with a few pixels between its extremes, so that it can be read between pixels.
  std::vector<double> waves;
  for (int i = 0; i < 60; ++i) {
    waves.push_back(static_cast<double>(random() % 1000) / 1000);
  }
  const auto level = [&](double x, double y) {
    double sum = 128;
    for (std::size_t i = 0; i < waves.size(); i += 3) {
      sum += 12 * std::sin(2 * waves[i] * x + 2 * waves[i + 1] * y + 6.3 * waves[i + 2]);
    }
    return static_cast<float>(sum);
  };
  Image<float> left(kWidth, kHeight);
  Image<float> right(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    left.at(x, y) = level(x, y) / 255;
    // x_left = x + d with d = −3 + 13 · x_left / width.
    const double x_left = (x - 3) / (1 - 13.0 / kWidth);
    right.at(x, y) = level(x_left, y + 0.3) / 255;
  }
  return {{std::move(left)}, {std::move(right)}};
}

void expect_within(const DisparityMap& map, DisparityRange search, const std::string& what) {
  for (const auto [x, y] : positions_of(map)) {
    const float d = map.at(x, y);
    if (!std::isfinite(d)) {
      continue;
    }
    ASSERT_GE(d, static_cast<float>(search.min)) << what << " at " << x << ", " << y;
    ASSERT_LE(d, static_cast<float>(search.max)) << what << " at " << x << ", " << y;
  }
}

TEST(SearchLimits, NoMethodAndNoRefinementLeavesThem) {
  const SlantedPair pair = slanted_pair();
  const std::vector<MethodCase> methods = method_cases(kSearch);
  constexpr Fill kFills[] = {Fill::kConstant, Fill::kLinear, Fill::kMedian,    Fill::kPlanes,
                             Fill::kSurfaces, Fill::kNone,   Fill::kCanonical, Fill::kThinPlate};
  DisparityMaps maps;
  const auto dimensions_fit = [&](const SampleRow& row) {
    // Coarse to fine and edge snapping are along rows only.
    return row[4] == 0 ||
           (methods[static_cast<std::size_t>(row[0])].options.resolved().levels == 1 &&
            row[3] == 0);
  };
  // Methods, fills, surface fit, edge snapping, dimensions.
  for (const SampleRow& row :
       sampled_rows({static_cast<int>(methods.size()), 7, 3, 2, 2}, dimensions_fit)) {
    MatchOptions options = methods[static_cast<std::size_t>(row[0])].options;
    options.raw = false;
    options.parameters.subpixel = Subpixel::kParabola;
    options.refinement.cross_check_px = 2;
    options.refinement.fill = kFills[row[1]];
    options.refinement.surface_fit_px = 5 * row[2];
    options.refinement.edge_snapping_px = 4 * row[3];
    if (row[4] == 1) {
      options.disparities_y = kSearchY;
    }
    StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
    const std::string what = methods[static_cast<std::size_t>(row[0])].name + ", fill " +
                             std::to_string(row[1]) + ", surface fit " +
                             std::to_string(5 * row[2]) + ", " + sample_name();
    expect_within(maps.left.disparity_px, kSearch, what);
    expect_within(maps.right.disparity_px, kSearch, what);
    if (row[4] == 1) {
      expect_within(maps.left.disparity_y_px, kSearchY, what + " (y)");
      expect_within(maps.right.disparity_y_px, kSearchY, what + " (y)");
    }
  }
}

TEST(SearchLimits, PresetsKeepThem) {
  const SlantedPair pair = slanted_pair();
  DisparityMaps maps;
  for (const MatchPreset preset :
       {MatchPreset::kRealtime, MatchPreset::kBalanced, MatchPreset::kQuality}) {
    MatchOptions options;
    options.preset = preset;
    options.disparities = kSearch;
    StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
    expect_within(maps.left.disparity_px, kSearch, "preset");
    expect_within(maps.right.disparity_px, kSearch, "preset");
  }
}

}  // namespace vantage::search_limits_test
