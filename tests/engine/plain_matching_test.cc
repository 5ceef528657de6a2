// The oracle itself, on cases small enough to work out by hand.
#include "tests/engine/plain_matching.h"

#include "tests/engine/engine_test.h"

namespace vantage::plain_matching_test {

Volume column_volume(const std::vector<double>& column) {
  Volume volume(1, 1, {0, static_cast<int>(column.size()) - 1}, Side::kLeft);
  volume.cells = column;
  return volume;
}

Photograph row_of(const std::vector<int>& grey_levels) {
  Image<std::uint8_t> image(static_cast<int>(grey_levels.size()), 1);
  for (int x = 0; x < image.width(); ++x) {
    image.at(x, 0) = static_cast<std::uint8_t>(grey_levels[static_cast<std::size_t>(x)]);
  }
  return {std::move(image)};
}

double cost_at(MatchCost cost, const Photograph& left, const Photograph& right, int x, int d) {
  MethodParameters parameters = book_parameters(MatchMethod::kSsd);
  parameters.cost = cost;
  parameters.prefilter = false;
  return plain_costs(left, right, Side::kLeft, {-3, 3}, parameters).at(x, 0, d + 3);
}

TEST(PlainCosts, ByHand) {
  const Photograph left = row_of({10, 20, 60, 30});
  const Photograph right = row_of({12, 50, 25, 200});
  // Left column 2 (60) and d = 1: right column 1 (50).
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kSquared, left, right, 2, 1), 100);
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kAbsolute, left, right, 2, 1), 10);
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kTruncated, left, right, 2, -1), 20);
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kTruncated, left, right, 2, 1), 10);
  // 60 and the interval 31 … 50 of 12, 50, 25; 50 and the interval 40 … 60 of 20, 60, 30.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kBirchfieldTomasi, left, right, 2, 1), 0);
  // 10 and 12 … 31; 12 and 10 … 15: border pixels have one neighbour.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kBirchfieldTomasi, left, right, 0, 0), 0);
  EXPECT_NEAR(cost_at(MatchCost::kContaminated, left, right, 2, 1),
              -std::log(.9 * std::exp(-100.0 / 50) + .1), 1e-14);
  // Left of the image: clamped to column 0 (12), but −log ε and no evidence.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kSquared, left, right, 1, 3), 64);
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kContaminated, left, right, 1, 3), -std::log(.1));
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kGradient, left, right, 1, 3), 0);
  // Gradients 10 (30 − 20) and 13 (25 − 12): (10 + 13)/2 − 3, negated.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kGradient, left, right, 2, 1), -8.5);
  // Darker than 60 are the four columns left of it (10, 10, 10, 20) and the four right of it (30):
  // on the centre row eight, on the six rows that replicate it eight each. Of 50: the same but 200.
  // Columns of right around 1: 12 12 12 12 | 50 | 25 200 200 200. Three columns differ, seven rows.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kCensus, left, right, 2, 1), 21);
  // Along the row and the diagonals all are darker than 60. Of 50, three along the row and two at
  // the end of diagonals are not.
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kRayCensus, left, right, 2, 1), 5);
}

TEST(PlainCosts, RayCensusWithThreeThresholds) {
  const Photograph left = row_of({100, 101, 100});
  const Photograph right = row_of({100, 102, 100});
  EXPECT_DOUBLE_EQ(cost_at(MatchCost::kRayCensus, left, right, 1, 0), 0);
  // Of the sixteen that are darker on both sides, those on the left are not 1.25 levels darker.
  MethodParameters parameters = book_parameters(MatchMethod::kSsd);
  parameters.cost = MatchCost::kRayCensus;
  parameters.census_thresholds = 3;
  EXPECT_DOUBLE_EQ(plain_costs(left, right, Side::kLeft, {0, 0}, parameters).at(1, 0, 0), 16.0 / 3);
}

TEST(PlainCosts, ColourAndDepths) {
  Image<std::uint16_t> left(1, 1, 3);
  Image<float> right(1, 1, 3);
  const double levels[3] = {65535, 0, 257};
  for (int c = 0; c < 3; ++c) {
    left.at(0, 0, c) = static_cast<std::uint16_t>(levels[c]);
    right.at(0, 0, c) = 0;
  }
  MethodParameters parameters = book_parameters(MatchMethod::kSsd);
  const Photograph a{std::move(left)};
  const Photograph b{std::move(right)};
  const double luma = .299 * 255 + .114;
  EXPECT_NEAR(plain_costs(a, b, Side::kLeft, {0, 0}, parameters).at(0, 0, 0), luma * luma, 1e-9);
  parameters.colour = ColourUse::kChannels;
  EXPECT_NEAR(plain_costs(a, b, Side::kLeft, {0, 0}, parameters).at(0, 0, 0),
              (255.0 * 255.0 + 1) / 3, 1e-9);
}

TEST(PlainCosts, GainsOfGradientFilters) {
  Plane ramp{9, 9, {}};
  for (const auto [x, y] : positions_of(9, 9)) {
    ramp.values.push_back(3.0 * x - 5.0 * y);
  }
  const auto expect_gain = [&](GradientFilter filter, double gain) {
    for (const bool prefilter : {false, true}) {
      const Gradient gradient = gradient_of(ramp, filter, prefilter);
      EXPECT_NEAR(gradient.x.at(4, 4), 3 * gain, 0.002 * gain);
      EXPECT_NEAR(gradient.y.at(4, 4), -5 * gain, 0.002 * gain);
    }
  };
  expect_gain(GradientFilter::kCentral, 2);
  expect_gain(GradientFilter::kSobel, 8);
  expect_gain(GradientFilter::kSimoncelli3, .9106);
  expect_gain(GradientFilter::kSimoncelli5, .9962);
  expect_gain(GradientFilter::kForward, 1);
  MethodParameters octagon;
  octagon.norm = GradientNorm::kOctagon;
  for (double angle = 0; angle < 6.3; angle += 0.01) {  // (5.17)
    EXPECT_NEAR(length_of(std::cos(angle), std::sin(angle), octagon), 1, 0.0397);
  }
}

TEST(PlainAggregation, BoxMeanByHand) {
  // A row of three columns, d = 0 and 1. At d = 1 column 0 has no partner.
  Volume costs(3, 1, {0, 1}, Side::kLeft);
  costs.cells = {3, 100, 6, 8, 15, 10};
  const Volume clipped = plain_box_mean(costs, 3, Border::kClip);
  EXPECT_DOUBLE_EQ(clipped.at(0, 0, 0), 4.5);
  EXPECT_DOUBLE_EQ(clipped.at(1, 0, 0), 8);
  EXPECT_DOUBLE_EQ(clipped.at(2, 0, 0), 10.5);
  EXPECT_TRUE(std::isnan(clipped.at(0, 0, 1)));
  EXPECT_DOUBLE_EQ(clipped.at(1, 0, 1), 9);
  EXPECT_DOUBLE_EQ(clipped.at(2, 0, 1), 9);
  for (const double mean : plain_box_mean(costs, 3, Border::kValid).cells) {
    EXPECT_TRUE(std::isnan(mean));  // a window of three rows does not fit
  }
  // Rows count as columns do.
  Volume column(1, 3, {0, 0}, Side::kLeft);
  column.cells = {3, 6, 15};
  EXPECT_DOUBLE_EQ(plain_box_mean(column, 3, Border::kClip).at(0, 1, 0), 8);
  EXPECT_DOUBLE_EQ(plain_box_mean(column, 3, Border::kClip).at(0, 2, 0), 10.5);
}

TEST(PlainAggregation, KernelsAreNormalisedAndHaveTheirVariance) {
  EXPECT_EQ(gaussian_taps(2).size(), 17U);
  EXPECT_EQ(box_cascade_taps(2).size(), 11U);  // 3 + 3 + 3 + 5 − 3
  for (const auto& taps : {gaussian_taps(2), box_cascade_taps(2)}) {
    double variance = 0;
    const int radius = static_cast<int>(taps.size()) / 2;
    for (int k = -radius; k <= radius; ++k) {
      variance += k * k * taps[static_cast<std::size_t>(k + radius)];
    }
    EXPECT_NEAR(std::accumulate(taps.begin(), taps.end(), 0.0), 1, 1e-14);
    EXPECT_NEAR(variance, 4, 0.01);
  }
  EXPECT_NEAR(box_cascade_taps(2)[0], 1.0 / (3 * 3 * 3 * 5), 1e-15);
}

TEST(PlainAggregation, OneStepOfDiffusionSpreadsAnImpulse) {
  Volume impulse(3, 2, {0, 1}, Side::kLeft);
  impulse.at(1, 0, 1) = 1;
  const Volume next = plain_diffusion(impulse, .15, 1);
  EXPECT_DOUBLE_EQ(next.at(1, 0, 1), 1 - 3 * .15);  // the neighbour above is absent
  EXPECT_DOUBLE_EQ(next.at(0, 0, 1), .15);
  EXPECT_DOUBLE_EQ(next.at(2, 0, 1), .15);
  EXPECT_DOUBLE_EQ(next.at(1, 1, 1), .15);
  EXPECT_DOUBLE_EQ(next.at(0, 1, 1), 0);
  EXPECT_DOUBLE_EQ(next.at(1, 0, 0), 0);
  const Volume pulled = plain_membrane(next, .15, .5, 0);
  EXPECT_EQ(pulled.cells, next.cells);
  // The second membrane step pulls towards the impulse.
  const Volume second = plain_membrane(impulse, .15, .5, 2);
  EXPECT_NEAR(second.at(0, 0, 1), .15 + .15 * (.5 * (0 - .15) + (.55 - .15) + (0 - .15)), 1e-15);
}

TEST(PlainAggregation, MembraneKeepsConstants) {
  const Volume constant(5, 4, {0, 2}, Side::kLeft, 3.25);
  for (const double cell : plain_membrane(constant, .15, .5, 7).cells) {
    EXPECT_NEAR(cell, 3.25, 1e-14);
  }
}

TEST(PlainAggregation, CertaintiesByHand) {
  EXPECT_DOUBLE_EQ(plain_margin({5, 2, 3}), .1);
  EXPECT_DOUBLE_EQ(plain_margin({2, 2, 3}), 0);
  EXPECT_DOUBLE_EQ(plain_margin({0, 0}), 0);
  EXPECT_DOUBLE_EQ(plain_margin({4}), 0);
  EXPECT_NEAR(plain_negative_entropy({7, 7, 7, 7}, 1), -std::log(4), 1e-14);
  EXPECT_NEAR(plain_negative_entropy({0, std::log(3)}, 1),
              .75 * std::log(.75) + .25 * std::log(.25), 1e-14);
  EXPECT_NEAR(plain_negative_entropy({0, 1e9}, 1), 0, 1e-14);
}

TEST(PlainAggregation, LocalStoppingRestoresSureColumns) {
  // Margins ⅓ and ⅐; a step of .2 makes both columns nearly alike: (1.6, 2.2), margin .158, and
  // (2.4, 2.8). The first is restored, the second improves from 0 to .077.
  Volume volume(2, 1, {0, 1}, Side::kLeft);
  volume.cells = {1, 2, 3, 3};
  const Volume next = plain_local_stopping(volume, .2, Certainty::kMargin, 1, 1);
  EXPECT_DOUBLE_EQ(next.at(0, 0, 0), 1);
  EXPECT_DOUBLE_EQ(next.at(0, 0, 1), 2);
  EXPECT_DOUBLE_EQ(next.at(1, 0, 0), 2.6);
  EXPECT_DOUBLE_EQ(next.at(1, 0, 1), 2.8);
}

TEST(PlainAggregation, BayesOfOnePixelByHand) {
  MethodParameters parameters = book_parameters(MatchMethod::kBayes);
  parameters.sigma_prior = .4;
  parameters.iterations = 0;
  const Volume energies = column_volume({-std::log(.6), -std::log(.2)});
  const Volume start = plain_bayes(energies, parameters);
  EXPECT_NEAR(start.at(0, 0, 0), .75, 1e-14);
  EXPECT_NEAR(start.at(0, 0, 1), .25, 1e-14);
  parameters.iterations = 1;
  for (const double mu : {.5, .3, 1.0}) {
    parameters.mu = mu;
    const double beside = .99 * std::exp(-1 / (2 * .4 * .4)) + .01;  // wP(1) ÷ wP(0)
    const double a = .75 * std::pow(.75 + beside * .25, mu);
    const double b = .25 * std::pow(.25 + beside * .75, mu);
    const Volume next = plain_bayes(energies, parameters);
    EXPECT_NEAR(next.at(0, 0, 0), a / (a + b), 1e-14) << mu;
    EXPECT_NEAR(next.at(0, 0, 1), b / (a + b), 1e-14) << mu;
  }
}

TEST(PlainSelection, ByHand) {
  MethodParameters parameters = book_parameters(MatchMethod::kMembrane);
  Volume volume(4, 1, {0, 3}, Side::kLeft);
  volume.cells = {9, 0, 0, 0,    // column 0: candidate 0 alone has a partner
                  9, 4, 0, 0,    // candidates 0 and 1
                  3, 1, 2, 0,    // candidates 0 to 2
                  5, 2, 2, 11};  // a tie
  const PlainMap map = plain_select(volume, parameters);
  EXPECT_EQ(map.at(0, 0).winner, 0);
  EXPECT_EQ(map.at(0, 0).confidence, 0);
  EXPECT_EQ(map.at(1, 0).winner, 1);
  EXPECT_EQ(map.at(1, 0).disparity, 1);
  EXPECT_DOUBLE_EQ(map.at(1, 0).confidence, 5.0 / 13);
  EXPECT_DOUBLE_EQ(map.at(2, 0).disparity, 1 + 1.0 / 6);
  EXPECT_DOUBLE_EQ(map.at(2, 0).confidence, 1.0 / 6);
  EXPECT_EQ(map.at(3, 0).winner, 1);
  EXPECT_DOUBLE_EQ(map.at(3, 0).disparity, 1.5);
  EXPECT_EQ(map.at(3, 0).runner_up, 2);
  EXPECT_TRUE(
      std::isnan(plain_select(Volume(2, 1, {2, 3}, Side::kLeft), parameters).at(1, 0).disparity));
}

}  // namespace vantage::plain_matching_test
