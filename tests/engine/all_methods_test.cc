// Every cost under every aggregation against the plain transcription of the equations.

#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/engine/table_keys.h"
#include "tests/test_sample.h"

namespace vantage::all_methods_test {

const std::vector<MatchCost> kCosts = all_costs();
const std::vector<Aggregation> kAggregations = all_aggregations();

/// Images that a method is looked at with.
struct ImageCase {
  PixelKind kind;
  int width;
  int height;
  DisparityRange range;
  ColourUse colour;
  Subpixel subpixel;
  std::uint32_t seed;
};
constexpr ImageCase kImages[] = {
    {PixelKind::kGrey8, 61, 43, {0, 12}, ColourUse::kLuma, Subpixel::kNone, 1},
    {PixelKind::kGrey8, 61, 43, {-7, 29}, ColourUse::kLuma, Subpixel::kNone, 1},
    {PixelKind::kColour8, 47, 31, {-2, 10}, ColourUse::kLuma, Subpixel::kParabola, 2},
    {PixelKind::kColour8, 47, 31, {-2, 10}, ColourUse::kChannels, Subpixel::kParabola, 2},
    {PixelKind::kGreyFloat, 47, 31, {-2, 10}, ColourUse::kLuma, Subpixel::kParabola, 2},
    {PixelKind::kGreyFloat, 47, 31, {-2, 10}, ColourUse::kChannels, Subpixel::kParabola, 2}};

MatchOptions options_of(MatchCost cost, Aggregation aggregation, const ImageCase& images) {
  MatchOptions options;
  options.disparities = images.range;
  options.parameters.cost = cost;
  options.parameters.aggregation = aggregation;
  options.parameters.subpixel = images.subpixel;
  options.parameters.colour = images.colour;
  if (aggregation == Aggregation::kBox) {
    options.parameters.window_px = 5;
  }
  if (cost_of(cost).is_evidence && aggregation == Aggregation::kLocalStopping) {
    options.parameters.certainty = Certainty::kEntropy;  // there is no margin of evidence
  }
  return options;
}

/// Every cost meets every aggregation and all images, and so does every aggregation.
const std::vector<SampleRow>& method_rows() {
  static const auto rows =
      sampled_rows({static_cast<int>(std::size(kCosts)), static_cast<int>(std::size(kAggregations)),
                    static_cast<int>(std::size(kImages))});
  return rows;
}

class AllMethods : public ::testing::TestWithParam<int> {};

TEST_P(AllMethods, EqualTheOracle) {
  for (const SampleRow& row : rows_of(method_rows(), GetParam())) {
    const Aggregation aggregation = kAggregations[static_cast<std::size_t>(row[1])];
    const ImageCase& images = kImages[row[2]];
    SCOPED_TRACE("images " + std::to_string(row[2]) + ", " + sample_name());
    const auto pair =
        textured_pair(images.width, images.height, images.range, images.kind, images.seed);
    const MatchOptions options =
        options_of(kCosts[static_cast<std::size_t>(row[0])], aggregation, images);
    expect_equals_oracle(pair, options, execution(), tolerance_of(options.resolved()),
                         case_name(aggregation));
  }
}

INSTANTIATE_TEST_SUITE_P(Costs, AllMethods,
                         ::testing::Range(0, static_cast<int>(std::size(kCosts))),
                         [](const auto& instance) {
                           return case_name(kCosts[static_cast<std::size_t>(instance.param)]);
                         });

}  // namespace vantage::all_methods_test
