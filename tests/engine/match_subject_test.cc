#include "engine/tuning/match_subject.h"

#include "engine/tuning/sequence_subject.h"
#include "engine/tuning/tuning_pair.h"
#include "tests/engine/engine_test.h"

namespace vantage::match_subject_test {

constexpr int kWidth = 211;
constexpr int kHeight = 97;

const TuningCoordinate& coordinate(std::string_view name) {
  return *std::ranges::find(kTuningCoordinates, name, &TuningCoordinate::name);
}

class MatchSubjectTest : public ::testing::Test {
 protected:
  MatchSubjectTest() {
    options_.match.disparities = {0, 31};
    options_.execution.threads = 2;
    pair_ = make_tuning_pair(kWidth, kHeight, options_.match.disparities, true, execution());
  }

  void use(MatchMethod method) { options_.match.method = method; }
  [[nodiscard]] std::vector<TunedSettings> candidates(std::string_view name,
                                                      const TunedSettings& incumbent = {},
                                                      bool finely = false) const {
    return MatchSubject(options_, pair_).candidates(coordinate(name), incumbent, finely);
  }

  MatchSubjectOptions options_;
  TuningPair pair_;
};

TEST_F(MatchSubjectTest, CandidatesChangeOneCoordinateAndAreInRange) {
  use(MatchMethod::kBayes);
  const TunedSettings incumbent = {.strip_width_px = 40, .band_height_px = 50};
  for (const bool finely : {false, true}) {
    for (const std::string name : {"strip-width", "band-height", "iterations-per-pass"}) {
      const std::vector<TunedSettings> all = candidates(name, incumbent, finely);
      EXPECT_FALSE(all.empty()) << name;
      for (const TunedSettings& one : all) {
        EXPECT_NO_THROW(one.validate());
        EXPECT_NE(one, incumbent);
        EXPECT_EQ(std::ranges::count(all, one), 1);
        if (name != "iterations-per-pass") {  // which may leave strips to the cost model
          TunedSettings back = one;
          back.*coordinate(name).field = incumbent.*coordinate(name).field;
          EXPECT_EQ(back, incumbent);
        }
      }
    }
  }
}

TEST_F(MatchSubjectTest, CandidatesAreOtherPlans) {
  // The width that the cost model chooses is no candidate under another name.
  Execution execution(options_.execution);
  const scheduler::ChainPlan plan =
      StereoMatcher(options_.match, execution).plan(pair_.left, pair_.right);
  for (const TunedSettings& one : candidates("strip-width")) {
    EXPECT_NE(one.strip_width_px, plan.passes.front().strip_columns);
  }
}

TEST_F(MatchSubjectTest, WhatIsGivenOrMakesNoSenseIsNotSearched) {
  EXPECT_TRUE(candidates("threads").empty()) << "given";
  EXPECT_TRUE(candidates("in-flight").empty()) << "of sequences only";
  EXPECT_TRUE(candidates("iterations-per-pass").empty()) << "windows have none";
  EXPECT_FALSE(candidates("band-height").empty());
  options_.searches_bands = false;
  EXPECT_TRUE(candidates("band-height").empty());
  options_.execution.strip_width_px = 32;
  EXPECT_TRUE(candidates("strip-width").empty());
}

TEST_F(MatchSubjectTest, MeasuresAnySettings) {
  MatchSubject subject(options_, pair_);
  EXPECT_EQ(subject.expected_seconds({}), 0) << "nothing is known yet";
  const double seconds = subject.measure({});
  EXPECT_GT(seconds, 0);
  EXPECT_GE(subject.expected_seconds({}), seconds);
  EXPECT_GT(subject.expected_seconds({.strip_width_px = 16}), 0) << "the cost model tells";
  for (const TunedSettings& one : subject.candidates(coordinate("strip-width"), {}, false)) {
    EXPECT_GT(subject.measure(one), 0) << to_string(one);
  }
}

TEST_F(MatchSubjectTest, RunsSequences) {
  SequenceSubject subject(options_, pair_);
  EXPECT_GE(subject.frames(), 8);
  const std::vector<TunedSettings> all = subject.candidates(coordinate("in-flight"), {}, false);
  EXPECT_FALSE(all.empty());
  EXPECT_GT(subject.measure({}), 0);
  for (const TunedSettings& one : all) {
    EXPECT_GT(subject.measure(one), 0) << to_string(one);
  }
}

TEST_F(MatchSubjectTest, PlansOfManyOptionsAreThoseOfEach) {
  Execution execution(options_.execution);
  const StereoMatcher matcher(options_.match, execution);
  std::vector<ExecutionOptions> all(3, options_.execution);
  all[1].strip_width_px = 50;
  all[2].threads = 5;
  const std::vector<scheduler::ChainPlan> plans = matcher.plans(pair_.left, pair_.right, all);
  ASSERT_EQ(plans.size(), 3U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Execution own(all[i]);
    const scheduler::ChainPlan plan =
        StereoMatcher(options_.match, own).plan(pair_.left, pair_.right);
    EXPECT_EQ(plans[i].passes.front().strip_columns, plan.passes.front().strip_columns);
    EXPECT_EQ(plans[i].passes.front().band_rows, plan.passes.front().band_rows);
    EXPECT_EQ(plans[i].passes.front().expected_time, plan.passes.front().expected_time);
  }
}

// Whatever a tuning file says: the same maps.
TEST_F(MatchSubjectTest, NoSettingsChangeAResult) {
  const std::vector<TunedSettings> odd = {
      {.threads = 3, .strip_width_px = 1, .band_height_px = 1, .iterations_per_pass = 1},
      {.threads = 1, .strip_width_px = 17, .band_height_px = 13, .iterations_per_pass = 7},
      {.threads = 5,
       .strip_width_px = 65500,
       .band_height_px = 65500,
       .iterations_per_pass = 10000}};
  for (const MatchMethod method :
       {MatchMethod::kSsd, MatchMethod::kBayes}) {  // of all: method_execution_test
    use(method);
    DisparityMaps expected;
    {
      StereoMatcher(options_.match, execution())
          .match(pair_.left, pair_.right, {.confidence = true}, expected);
    }
    for (const TunedSettings& settings : odd) {
      Execution execution(with_tuned({}, settings));
      DisparityMaps maps;
      StereoMatcher(options_.match, execution)
          .match(pair_.left, pair_.right, {.confidence = true}, maps);
      EXPECT_TRUE(identical(maps, expected)) << to_string(settings);
    }
  }
}

}  // namespace vantage::match_subject_test
