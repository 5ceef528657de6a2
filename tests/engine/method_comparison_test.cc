#include "engine/evaluation/method_comparison.h"

#include "tests/engine/engine_test.h"

namespace vantage::method_comparison_test {

const std::vector<std::string> kFour = {"ssd", "membrane", "local-stopping-margin", "bayes"};

ComparisonOptions small_options(std::vector<std::string> pairs) {
  return {.pairs = std::move(pairs),
          .noise_sigmas = {0, 0.25},
          .methods = kFour,
          .iterations = {3},
          .size_px = 40};
}

TEST(MethodComparison, RunsComeInOrder) {
  const auto runs = compare_methods(small_options({"rds-square", "real-bars"}), execution());
  ASSERT_EQ(runs.size(), 2U * 2 * 4);
  EXPECT_EQ(runs[0].pair, "rds-square");
  EXPECT_EQ(runs[15].pair, "real-bars");
  EXPECT_EQ(runs[4].noise_sigma, 0.25);
  EXPECT_EQ(runs[3].method, "bayes");
  for (const ComparisonRun& run : runs) {
    EXPECT_EQ(run.map.width(), 40);
    EXPECT_EQ(run.iterations, run.method == "ssd" ? 0 : 3);
    EXPECT_GT(run.scores.evaluated_pixels, 800);
    EXPECT_TRUE(std::isfinite(run.scores.rms_px));
    EXPECT_GE(run.scores.rms_px, run.scores.average_px);
  }
}

TEST(MethodComparison, OnlyVisiblePixelsCount) {
  const auto runs = compare_methods(small_options({"rds-square"}), execution());
  BookPairOptions options = book_pair_options("rds-square");
  options.width_px = options.height_px = 40;
  const BookPair pair = make_book_pair(options);
  int visible = 0;
  for (const auto [x, y] : positions_of(40, 40)) {
    visible += pair.left_occluded.at(x, y) == 0 ? 1 : 0;
  }
  EXPECT_EQ(runs.front().scores.evaluated_pixels, visible);
}

TEST(MethodComparison, IsIdenticalForAnyThreads) {
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution three({.threads = 3});
  const auto options = small_options({"real-square"});
  const auto expected = compare_methods(options, one);
  const auto runs = compare_methods(options, three);
  ASSERT_EQ(runs.size(), expected.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].scores.rms_px, expected[i].scores.rms_px);
    EXPECT_EQ(runs[i].scores.bad_0_5_percent, expected[i].scores.bad_0_5_percent);
  }
}

TEST(MethodComparison, ParametersGoToTheMethodsThatReadThem) {
  MethodOverrides more;
  more.beta = 0.7;
  more.window_px = 3;
  const auto options_of = [&more](std::string_view name) {
    const MatchOptions options =
        compared_options(compared_method(name), BookPattern::kGrass, 4, more);
    options.validate();
    return options.resolved();
  };
  EXPECT_EQ(options_of("membrane").beta, 0.7);
  EXPECT_EQ(options_of("membrane").iterations, 4);
  EXPECT_EQ(options_of("ssd").window_px, 3);
  EXPECT_EQ(options_of("bayes").sigma_measurement, 8);
  // Another aggregation reads other parameters.
  more = {};
  more.aggregation = Aggregation::kBox;
  more.window_px = 7;
  EXPECT_EQ(options_of("membrane").window_px, 7);
}

TEST(MethodComparison, EveryMethodMatchesSmallPairs) {
  ComparisonOptions options = small_options({"rds-square"});
  options.noise_sigmas = {0};
  options.methods.clear();
  for (const ComparedMethod& method : compared_methods()) {
    options.methods.emplace_back(method.name);
  }
  for (const ComparisonRun& run : compare_methods(options, execution())) {
    EXPECT_LT(run.scores.bad_0_5_percent, 60) << run.method;
  }
}

// What the book's experiments show, at their full size (EQUATIONS §4).
TEST(MethodComparison, BayesIsAlmostPerfectWithLittleNoiseAndTheBestOfFour) {
  const auto runs = compare_methods({.pairs = {kBookPairNames.begin(), kBookPairNames.end()},
                                     .noise_sigmas = {0, 0.25, 0.5, 1, 2},
                                     .methods = kFour},
                                    execution());
  ASSERT_EQ(runs.size(), 5U * 5 * 4);
  for (std::size_t i = 0; i < runs.size(); i += kFour.size()) {
    const ComparisonRun& bayes = runs[i + 3];
    ASSERT_EQ(bayes.method, "bayes");
    if (bayes.noise_sigma <= 1) {
      EXPECT_LE(bayes.scores.bad_0_5_percent, 0.5) << bayes.pair << ' ' << bayes.noise_sigma;
    }
    for (std::size_t method = 0; method < 3; ++method) {
      EXPECT_LE(bayes.scores.bad_0_5_percent, runs[i + method].scores.bad_0_5_percent)
          << bayes.pair << ' ' << bayes.noise_sigma;
      EXPECT_LE(bayes.scores.rms_px, runs[i + method].scores.rms_px)
          << bayes.pair << ' ' << bayes.noise_sigma;
    }
  }
}

TEST(MethodComparison, DiffusionBlursOnWhereTheOthersConverge) {
  const auto runs = compare_methods(
      {.pairs = {"ramp-square"},
       .noise_sigmas = {0},
       .methods = {"diffusion", "local-stopping-margin", "local-stopping-entropy", "membrane"},
       .iterations = {30, 100},
       .size_px = 60},
      execution());
  ASSERT_EQ(runs.size(), 4U * 2);
  for (std::size_t i = 0; i < runs.size(); i += 2) {
    const double before = runs[i].scores.bad_0_5_percent;
    const double after = runs[i + 1].scores.bad_0_5_percent;
    EXPECT_EQ(runs[i + 1].iterations, 100);
    if (runs[i].method == "diffusion") {
      EXPECT_GT(after, before + 1);
    } else {
      EXPECT_NEAR(after, before, 0.5) << runs[i].method;
    }
  }
}

TEST(MethodComparison, CanBeStopped) {
  const std::atomic<bool> stop = true;
  EXPECT_TRUE(compare_methods(small_options({"rds-square"}), execution(), &stop).empty());
}

TEST(MethodComparison, RefusesBadOptions) {
  const auto refuses = [](const auto& change) {
    ComparisonOptions options = small_options({"rds-square"});
    change(options);
    EXPECT_THROW(compare_methods(options, execution()), UsageError);
  };
  refuses([](ComparisonOptions& options) { options.pairs.clear(); });
  refuses([](ComparisonOptions& options) { options.pairs = {"stripes"}; });
  refuses([](ComparisonOptions& options) { options.methods = {"guess"}; });
  refuses([](ComparisonOptions& options) { options.noise_sigmas = {-1}; });
  refuses([](ComparisonOptions& options) { options.iterations = {-1}; });
  refuses([](ComparisonOptions& options) { options.size_px = 15; });
}

}  // namespace vantage::method_comparison_test
