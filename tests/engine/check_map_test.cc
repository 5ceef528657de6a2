// What maps are checked against where the finest level is pruned or searched in windows: smooth
// tiles have coarse winners.

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/windows/window_level.h"
#include "engine/refinement/refinement.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::check_map_test {

constexpr int kWidth = 197;
constexpr int kHeight = 93;
constexpr DisparityRange kRange{0, 45};

/// A surface before another one, both without slopes: most tiles are smooth.
PhotographPair two_surfaces() {
  const auto world = textured_pair(kWidth + 64, kHeight, {0, 1}, PixelKind::kGrey8, 5);
  const auto& texture = std::get<Image<std::uint8_t>>(world.left.pixels);
  Image<std::uint8_t> left(kWidth, kHeight);
  Image<std::uint8_t> right(kWidth, kHeight);
  const auto copy = [&](int disparity, int first, int end, int rows) {
    for (const auto [x, y] : positions_of({std::max(first, 0), std::min(end, kWidth)}, {0, rows})) {
      left.at(x, y) = texture.at(x, y);
      if (x - disparity >= 0) {
        right.at(x - disparity, y) = texture.at(x, y);
      }
    }
  };
  for (int y = 0; y < kHeight; ++y) {
    std::copy_n(texture.row(y) + 6, kWidth, right.row(y));
  }
  copy(6, 0, kWidth, kHeight);
  copy(31, 70, 130, 60);
  return {Photograph{std::move(left)}, Photograph{std::move(right)}};
}

MatchOptions options_of(int final_iterations, int window_levels) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = kRange;
  options.parameters.cost = MatchCost::kRayCensus;
  options.parameters.sigma_measurement = 4;
  options.parameters.levels = 4;
  options.parameters.iterations = 2;
  options.parameters.final_iterations = final_iterations;
  options.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  options.parameters.candidate_blocks = 2;
  options.parameters.window_levels = window_levels;
  options.refinement.cross_check_px = 1;
  options.refinement.fill = Fill::kNone;
  return options;
}

/// The winners of level 1.
Image<std::int32_t> coarse_winners(const PhotographPair& pair, const MatchOptions& options,
                                   Side reference) {
  const MethodParameters parameters = options.resolved();
  const bool is_left = reference == Side::kLeft;
  const auto geometry = candidate_geometry(options.in_force(), reference, kWidth, kHeight);
  CostImage left;
  CostImage right;
  const auto margins = window_margins(geometry);
  left.prepare(pair.left, parameters, margins, {is_left, false, true}, execution());
  right.prepare(pair.right, parameters, margins, {!is_left, is_left, true}, execution());
  DisparityMap size_alone(kWidth, kHeight);
  EdgeWeightLevels edges;
  CoarseLevels levels;
  const ChainInput input{nullptr,
                         is_left ? &left : &right,
                         {CostPartner{is_left ? &right : &left}},
                         {},
                         0,
                         edges.prepare(is_left ? pair.left : pair.right, parameters, execution())};
  Image<std::int32_t> winners;
  CoarseToFine(
      {parameters, geometry, input},
      {.outputs = {.disparity_px = size_alone.view()}, .coarse = {.level = 1, .winners = &winners}},
      levels, execution(),
      [](const MatchChain& chain) { scheduler::run_whole_image(chain.stages()); })
      .search();
  return winners;
}

bool is_smooth(const Image<std::int32_t>& winners, int tile_x, int tile_y) {
  const int end_x = std::min(4 * tile_x + 5, winners.width());
  const int end_y = std::min(4 * tile_y + 5, winners.height());
  for (const auto [x, y] :
       positions_of({std::max(4 * tile_x - 1, 0), end_x}, {std::max(4 * tile_y - 1, 0), end_y})) {
    const int here = winners.at(x, y);
    if ((x + 1 < end_x && std::abs(winners.at(x + 1, y) - here) > 2) ||
        (y + 1 < end_y && std::abs(winners.at(x, y + 1) - here) > 2)) {
      return false;
    }
  }
  return true;
}

struct Case {
  int final_iterations;
  int window_levels;
  /// More iterations without windows read too far into smooth tiles.
  [[nodiscard]] bool has_check_map() const { return window_levels > 0 || final_iterations <= 1; }
};

TEST(CheckMap, IsTheMapButInSmoothTilesCoarseWinners) {
  const auto pair = two_surfaces();
  for (const Case& of : {Case{0, 0}, {1, 0}, {2, 0}, {1, 1}, {2, 1}}) {
    const int final_iterations = of.final_iterations;
    const MatchOptions options = options_of(final_iterations, of.window_levels);
    MatchOptions raw = options;
    raw.raw = true;
    raw.refinement = {};
    const DisparityMaps winners = maps_of(pair, raw);
    DisparityMap check_px(kWidth, kHeight);
    const Image<std::int32_t> coarse = coarse_winners(pair, raw, Side::kRight);
    int smooth = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const bool is_coarse = of.has_check_map() && is_smooth(coarse, x / 8, y / 8);
      check_px.at(x, y) = is_coarse ? static_cast<float>(coarse.at(x / 2, y / 2))
                                    : winners.right.disparity_px.at(x, y);
      smooth += is_coarse ? 1 : 0;
    }
    EXPECT_EQ(smooth > kWidth * kHeight / 3, of.has_check_map()) << smooth;
    Mask expected;
    cross_check(winners.left.disparity_px.view(), std::as_const(check_px).view(), Side::kLeft, 1,
                execution(), expected);
    EXPECT_TRUE(identical(maps_of(pair, options).left.unmatched, expected))
        << final_iterations << " iterations, " << of.window_levels << " levels of windows";
  }
}

TEST(CheckMap, LeavesTilesOutAndChangesNoMap) {
  const auto pair = two_surfaces();
  for (const Case& of : {Case{0, 0}, {1, 0}, {2, 1}, {1, 1}}) {
    const MatchOptions options = options_of(of.final_iterations, of.window_levels);
    MatchReport of_both;
    const DisparityMaps both = maps_of(pair, options, {.threads = 1}, {}, &of_both);
    for (const int strip_px : {23, 1000}) {
      const ExecutionOptions how{.threads = 2, .strip_width_px = strip_px, .band_height_px = 11};
      MatchReport of_left;
      const DisparityMaps left =
          maps_of(pair, options, how, {.left = true, .right = false}, &of_left);
      EXPECT_TRUE(identical(left.left.disparity_px, both.left.disparity_px));
      EXPECT_TRUE(identical(left.left.unmatched, both.left.unmatched));
      const DisparityMaps right = maps_of(pair, options, how, {.left = false, .right = true});
      EXPECT_TRUE(identical(right.right.disparity_px, both.right.disparity_px));
      EXPECT_TRUE(identical(right.right.unmatched, both.right.unmatched));
      EXPECT_LT(of_left.finest_cells, 0.9 * of_both.finest_cells);
    }
  }
}

}  // namespace vantage::check_map_test
