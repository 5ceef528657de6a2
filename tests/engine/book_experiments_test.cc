#include "engine/evaluation/book_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace book_experiments_test {

BookExperimentOptions small_options(std::vector<std::string> pairs) {
  BookExperimentOptions options;
  options.pairs = std::move(pairs);
  options.size_px = 40;
  options.iterations = 3;
  return options;
}

TEST(BookExperiments, NoiseRunsComeInOrder) {
  Execution execution({.threads = 2});
  std::vector<int> progress;
  const auto runs = run_noise_experiment(small_options({"rds-square", "real-bars"}), execution,
                                         {.on_run = [&](int done, int total) {
                                           progress.push_back(done);
                                           EXPECT_EQ(total, 64);
                                         }});
  ASSERT_EQ(runs.size(), 2U * 8 * 4);
  EXPECT_EQ(runs[0].pair, "rds-square");
  EXPECT_EQ(runs[63].pair, "real-bars");
  EXPECT_EQ(runs[4].noise_sigma, 0.25);
  EXPECT_EQ(runs[3].method, ExperimentMethod::kBayes);
  ASSERT_EQ(progress.size(), 64U);
  EXPECT_EQ(progress.back(), 64);
  for (const ExperimentRun& run : runs) {
    EXPECT_EQ(run.map.width(), 40);
    EXPECT_GT(run.scores.evaluated_pixels, 800);
    EXPECT_TRUE(std::isfinite(run.scores.rms_px));
    EXPECT_GE(run.scores.rms_px, run.scores.average_px);
  }
}

TEST(BookExperiments, OnlyVisiblePixelsCount) {
  Execution execution({.threads = 1});
  const auto runs = run_noise_experiment(small_options({"rds-square"}), execution, {});
  BookPairOptions options = book_pair_options("rds-square");
  options.width_px = options.height_px = 40;
  const BookPair pair = make_book_pair(options);
  int visible = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      visible += pair.left_occluded.at(x, y) == 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(runs.front().scores.evaluated_pixels, visible);
}

TEST(BookExperiments, AreIdenticalForAnyThreads) {
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution three({.threads = 3});
  const auto options = small_options({"real-square"});
  const auto expected = run_noise_experiment(options, one, {});
  const auto runs = run_noise_experiment(options, three, {});
  ASSERT_EQ(runs.size(), expected.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].scores.rms_px, expected[i].scores.rms_px);
    EXPECT_EQ(runs[i].scores.bad_0_5_percent, expected[i].scores.bad_0_5_percent);
  }
}

// What the book's experiments show, at their full size (EQUATIONS §4).
TEST(BookExperiments, BayesIsAlmostPerfectWithLittleNoiseAndTheBestOfFour) {
  Execution execution({.threads = 2});
  const auto runs = run_noise_experiment({}, execution, {});
  ASSERT_EQ(runs.size(), 5U * 8 * 4);
  for (std::size_t i = 0; i < runs.size(); i += kNoiseMethods.size()) {
    const ExperimentRun& bayes = runs[i + 3];
    ASSERT_EQ(bayes.method, ExperimentMethod::kBayes);
    if (bayes.noise_sigma <= 1) {
      EXPECT_LE(bayes.scores.bad_0_5_percent, 0.5) << bayes.pair << ' ' << bayes.noise_sigma;
    }
    if (bayes.noise_sigma <= 2) {
      for (std::size_t method = 0; method < 3; ++method) {
        EXPECT_LE(bayes.scores.bad_0_5_percent, runs[i + method].scores.bad_0_5_percent)
            << bayes.pair << ' ' << bayes.noise_sigma;
        EXPECT_LE(bayes.scores.rms_px, runs[i + method].scores.rms_px)
            << bayes.pair << ' ' << bayes.noise_sigma;
      }
    }
  }
}

TEST(BookExperiments, DiffusionBlursOnWhereTheOthersConverge) {
  Execution execution({.threads = 2});
  BookExperimentOptions options;
  options.size_px = 60;
  const auto runs = run_iteration_experiment(options, execution, {});
  constexpr std::size_t kSteps = kExperimentIterations.size();
  ASSERT_EQ(runs.size(), kIterationMethods.size() * kSteps);
  for (std::size_t method = 0; method < kIterationMethods.size(); ++method) {
    const auto& last = runs[method * kSteps + kSteps - 1];
    const auto& before = runs[method * kSteps + kSteps - 2];
    EXPECT_EQ(last.iterations, 100);
    EXPECT_EQ(last.pair, "ramp-square");
    if (last.method == ExperimentMethod::kDiffusion) {
      EXPECT_GT(last.scores.bad_0_5_percent, before.scores.bad_0_5_percent + 1);
    } else {
      EXPECT_NEAR(last.scores.bad_0_5_percent, before.scores.bad_0_5_percent, 0.5);
    }
  }
}

TEST(BookExperiments, CanBeStopped) {
  Execution execution({.threads = 1});
  const std::atomic<bool> stop = true;
  EXPECT_TRUE(
      run_noise_experiment(small_options({"rds-square"}), execution, {.stop = &stop}).empty());
}

TEST(BookExperiments, RefuseBadOptions) {
  Execution execution({.threads = 1});
  EXPECT_THROW(run_noise_experiment(small_options({}), execution, {}), UsageError);
  EXPECT_THROW(run_noise_experiment(small_options({"stripes"}), execution, {}), UsageError);
  BookExperimentOptions options;
  options.size_px = 15;
  EXPECT_THROW(run_iteration_experiment(options, execution, {}), UsageError);
  options = {};
  options.iterations = -1;
  EXPECT_THROW(run_noise_experiment(options, execution, {}), UsageError);
}

}  // namespace book_experiments_test
}  // namespace vantage
