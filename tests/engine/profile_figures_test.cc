// Figures of profiles, against arithmetic by hand.

#include "engine/profiling/profile_figures.h"

#include "tests/engine/engine_test.h"

#include "engine/profiling/stage_figures.h"

namespace vantage::profile_figures_test {

TEST(SampleOf, IsMedianLeastAndMost) {
  const ProfileSample odd = sample_of({3, 9, 1});
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.min, 1);
  EXPECT_EQ(odd.max, 9);
  EXPECT_EQ(sample_of({4, 1, 2, 8}).median, 3);
  EXPECT_EQ(sample_of({7}).min, 7);
  EXPECT_EQ(sample_of({}).median, 0);
}

TEST(SpeedUps, AreRatiosOfOneRound) {
  // The machine slows down by half after each round: ratios do not notice.
  const std::vector<WallTimes> times = {{1, {8, 12, 18}}, {2, {4, 6, 9}}, {4, {4, 3, 6}}};
  const std::vector<SpeedUp> all = speed_ups(times);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].ratio.median, 1);
  EXPECT_EQ(all[0].efficiency, 1);
  EXPECT_FALSE(all[0].serial_fraction);
  EXPECT_EQ(all[1].ratio.min, 2);
  EXPECT_EQ(all[1].ratio.max, 2);
  EXPECT_EQ(all[1].efficiency, 1);
  EXPECT_NEAR(*all[1].serial_fraction, 0, 1e-12);
  EXPECT_EQ(all[2].ratio.median, 3);  // of 2, 4, 3
  EXPECT_EQ(all[2].ratio.min, 2);
  EXPECT_EQ(all[2].ratio.max, 4);
  EXPECT_EQ(all[2].efficiency, 0.75);
  EXPECT_NEAR(*all[2].serial_fraction, (1.0 / 3 - 1.0 / 4) / (3.0 / 4), 1e-12);
}

TEST(SpeedUps, CountThreadsByTheFewest) {
  const std::vector<SpeedUp> all = speed_ups(std::vector<WallTimes>{{2, {10}}, {8, {5}}});
  EXPECT_EQ(all[1].efficiency, 0.5);  // twice as fast with four times as many
  EXPECT_NEAR(*all[1].serial_fraction, karp_flatt(2, 4), 1e-12);
}

TEST(KarpFlatt, FindsTheFractionOfAmdahlsLaw) {
  for (const double serial : {0.0, 0.05, 0.3, 1.0}) {
    for (const double processors : {2.0, 3.0, 16.0}) {
      const double speed_up = 1 / (serial + (1 - serial) / processors);
      EXPECT_NEAR(karp_flatt(speed_up, processors), serial, 1e-12);
    }
  }
  EXPECT_LT(karp_flatt(2.1, 2), 0);
}

SpeedUp speed_up(int threads, double ratio) {
  SpeedUp one;
  one.threads = threads;
  one.ratio.median = ratio;
  return one;
}

TEST(AmdahlFit, FindsTheFractionThatMadeTheSpeedUps) {
  constexpr double kSerial = 0.12;
  std::vector<SpeedUp> all;
  for (const int threads : {1, 2, 4, 8, 16}) {
    all.push_back(speed_up(threads, 1 / (kSerial + (1 - kSerial) / threads)));
  }
  EXPECT_NEAR(*amdahl_fit(all), kSerial, 1e-12);
}

TEST(AmdahlFit, IsTheLeastOfTheSquares) {
  const std::array<SpeedUp, 3> all = {speed_up(1, 1), speed_up(2, 1.7), speed_up(4, 2.6)};
  const auto squares = [&](double serial) {
    double sum = 0;
    for (const SpeedUp& one : all) {
      const double difference = 1 / one.ratio.median - (serial + (1 - serial) / one.threads);
      sum += difference * difference;
    }
    return sum;
  };
  const double fitted = *amdahl_fit(all);
  EXPECT_LT(squares(fitted), squares(fitted - 1e-4));
  EXPECT_LT(squares(fitted), squares(fitted + 1e-4));
}

TEST(AmdahlFit, NeedsTwoNumbersOfThreads) {
  EXPECT_FALSE(amdahl_fit(std::array{speed_up(3, 1)}));
  EXPECT_FALSE(amdahl_fit({}));
}

TEST(ProcessorGrowthTable, IsTimeOfAFrameAgainstTheFewestThreads) {
  const auto part = [](const char* name, double processor_s) {
    PartProfile one;
    one.name = name;
    one.seconds.median = 100;  // of waiting for a processor, too
    one.processor_s.median = processor_s;
    return one;
  };
  Profile profile;
  for (const auto& [threads, frames, search_s] :
       {std::tuple(2, 4.0, 2.0), std::tuple(16, 8.0, 5.0)}) {
    ThreadCountProfile& count = profile.thread_counts.emplace_back();
    count.threads = threads;
    count.frames = frames;
    count.frame_steps = {part("match", search_s + 1), part("views", 0.001)};
    count.parts = {part("match left", search_s), part("views", 0.001), part("tiny", 0.001)};
    StageProfile stage;
    stage.name = "cost";
    stage.seconds.median = search_s / 2;
    count.stages = {stage};
  }
  profile.thread_counts[1].parts.push_back(part("new", 1));  // nothing to compare with
  const std::vector<ProcessorGrowth> all = processor_growth(profile);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].name, "match");
  EXPECT_EQ(all[0].kind, "step");
  EXPECT_EQ(all[0].ms, (std::vector<double>{750, 750}));
  EXPECT_EQ(all[0].growth, (std::vector<double>{0, 0}));
  EXPECT_EQ(all[1].name, "views");
  EXPECT_EQ(all[2].name, "match left");
  EXPECT_EQ(all[2].kind, "part");
  EXPECT_EQ(all[2].ms, (std::vector<double>{500, 625}));
  EXPECT_EQ(all[2].growth, (std::vector<double>{0, 0.25}));
  EXPECT_EQ(all[3].kind, "stage");
  EXPECT_EQ(all[3].growth, (std::vector<double>{0, 0.25}));
  EXPECT_TRUE(processor_growth({}).empty());
}

TEST(StageFigures, AreWhatTheCountsComeTo) {
  StageProfile stage;
  EXPECT_EQ(nanoseconds_per_cell(stage), 0);
  EXPECT_EQ(cells_per_second(stage), 0);
  EXPECT_EQ(halo_share(stage), 0);
  stage.seconds.median = 2;
  stage.cells = 4e9;
  stage.columns = 125;
  stage.own_columns = 100;
  EXPECT_EQ(nanoseconds_per_cell(stage), 0.5);
  EXPECT_EQ(cells_per_second(stage), 2e9);
  EXPECT_EQ(halo_share(stage), 0.25);
}

}  // namespace vantage::profile_figures_test
