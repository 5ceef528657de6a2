// Costs of coarse levels that are made once for both images: maps are those of each image alone.

#include "engine/matching/chain/match_chain.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::cost_sharing_test {

MatchOptions options_of(DisparityRange range) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = range;
  options.raw = true;
  options.parameters.cost = MatchCost::kRayCensus;
  options.parameters.sigma_measurement = 4;
  options.parameters.levels = 3;
  options.parameters.iterations = 1;
  options.parameters.final_iterations = 1;
  options.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  return options;
}

DisparityMaps matched(const PhotographPair& pair, const MatchOptions& options,
                      const MatchRequest& request, const ExecutionOptions& how) {
  Execution execution(how);
  const StereoMatcher matcher(options, execution);
  DisparityMaps maps;
  matcher.match(pair.left, pair.right, request, maps);
  matcher.match(pair.left, pair.right, request, maps);  // in the memory of the first
  return maps;
}

TEST(CostSharing, MapsAreThoseOfEachImageAlone) {
  for (const auto& [width, height, range] :
       {std::tuple{64, 31, DisparityRange{0, 20}}, std::tuple{75, 20, DisparityRange{-7, 9}},
        std::tuple{33, 9, DisparityRange{-70, 70}}, std::tuple{130, 17, DisparityRange{21, 60}}}) {
    const auto pair = textured_pair(width, height, range, PixelKind::kGrey8, 3);
    for (const SearchSize size : {SearchSize::kFull, SearchSize::kHalf}) {
      MatchOptions options = options_of(range);
      options.parameters.search_size = size;
      const std::string what = std::to_string(width) + "x" + std::to_string(height);
      const DisparityMaps both = matched(pair, options, {}, {.threads = 2, .band_height_px = 3});
      const DisparityMaps left = matched(pair, options, {.right = false}, {.threads = 1});
      const DisparityMaps right = matched(pair, options, {.left = false}, {.threads = 1});
      EXPECT_TRUE(identical(both.left.disparity_px, left.left.disparity_px)) << what;
      EXPECT_TRUE(identical(both.right.disparity_px, right.right.disparity_px)) << what;
    }
  }
}

TEST(CostSharing, IsForByteCostsOfOnePartnerAndImagesThatAreNotLarge) {
  MethodParameters parameters = options_of({0, 20}).resolved();
  ChainInput input{nullptr, nullptr, {CostPartner{}}};
  EXPECT_TRUE(shares_costs(parameters, input, {640, 480}, 64));
  EXPECT_FALSE(shares_costs(parameters, input, {1920, 1080}, 256));
  input.partners.emplace_back();
  EXPECT_FALSE(shares_costs(parameters, input, {640, 480}, 64));
  input.partners = {CostPartner{.baseline_ratio = 2}};
  EXPECT_FALSE(shares_costs(parameters, input, {640, 480}, 64));
  parameters.cost = MatchCost::kSquared;
  EXPECT_FALSE(can_share_costs(parameters, {640, 480}, 64));
}

}  // namespace vantage::cost_sharing_test
