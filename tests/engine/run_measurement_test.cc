#include "engine/profiling/run_measurement.h"

#include "tests/engine/engine_test.h"

namespace vantage::run_measurement_test {

RunMeasurement measured(double wall_s) {
  RunMeasurement run;
  run.wall_s = wall_s;
  run.compute_s = wall_s / 2;
  run.stages["cost"] = {.seconds = 10 * wall_s,
                        .columns = 110,
                        .own_columns = 100,
                        .cells = 7,
                        .operations = 5,
                        .bytes = 3};
  run.waits["idle"] = {wall_s, 2};
  run.workers = {{"main", true, wall_s, 0}, {"worker 1", true, wall_s / 3, 0}, {"other", false, 9}};
  run.waiting_for.reading_s = 4 * wall_s;
  run.peak_memory_bytes = static_cast<std::uint64_t>(1000 * wall_s);
  return run;
}

TEST(SummariseRuns, TakesMediansAndRanges) {
  const std::vector<RunMeasurement> runs = {measured(3), measured(1), measured(2)};
  const ThreadCountProfile profile = summarise_runs(2, runs);
  EXPECT_EQ(profile.threads, 2);
  EXPECT_EQ(profile.runs, 3);
  EXPECT_EQ(profile.wall_s.median, 2);
  EXPECT_EQ(profile.wall_s.min, 1);
  EXPECT_EQ(profile.wall_s.max, 3);
  EXPECT_EQ(profile.compute_s.median, 1);
  EXPECT_EQ(profile.peak_memory_bytes.max, 3000);
  EXPECT_EQ(profile.waiting_for.reading_s.median, 8);
  ASSERT_EQ(profile.stages.size(), 1U);
  EXPECT_EQ(profile.stages[0].seconds.median, 20);
  EXPECT_EQ(profile.stages[0].columns, 110);
  EXPECT_EQ(profile.stages[0].own_columns, 100);
  EXPECT_EQ(profile.stages[0].cells, 7);
  EXPECT_EQ(profile.stages[0].operations, 5);
  EXPECT_EQ(profile.stages[0].bytes, 3);
  ASSERT_EQ(profile.waits.size(), 1U);
  EXPECT_EQ(profile.waits[0].count, 2);
  EXPECT_NEAR(profile.imbalance.median, 1 / ((1 + 1.0 / 3) / 2), 1e-12);
  EXPECT_EQ(profile.workers.front().work_s, 2);  // of the run with the median wall time
}

TEST(SummariseRuns, SortsByTimeAndCountsWhatIsMissingAsNone) {
  std::vector<RunMeasurement> runs(3);
  for (RunMeasurement& run : runs) {
    run.parts["short"] = {1, 1};
    run.parts["long"] = {5, 1};
  }
  runs[0].parts["once"] = {9, 1};
  const ThreadCountProfile profile = summarise_runs(1, runs);
  ASSERT_EQ(profile.parts.size(), 3U);
  EXPECT_EQ(profile.parts[0].name, "long");
  EXPECT_EQ(profile.parts[1].name, "short");
  EXPECT_EQ(profile.parts[2].name, "once");
  EXPECT_EQ(profile.parts[2].seconds.median, 0);
  EXPECT_EQ(profile.parts[2].seconds.max, 9);
}

TEST(MedianRun, IsTheFasterOfTwoInTheMiddle) {
  EXPECT_EQ(median_run(std::vector{measured(5), measured(1), measured(3)}), 2U);
  EXPECT_EQ(median_run(std::vector{measured(4), measured(1), measured(3), measured(2)}), 3U);
  EXPECT_EQ(median_run(std::vector{measured(4)}), 0U);
}

TEST(ImbalanceOf, IsOneWhereAllDoTheSameOrNothing) {
  EXPECT_EQ(imbalance_of({}), 1);
  const std::vector<ThreadProfile> equal = {{"a", true, 2, 0}, {"b", true, 2, 0}};
  EXPECT_EQ(imbalance_of(equal), 1);
  const std::vector<ThreadProfile> one_works = {{"a", true, 2, 0}, {"b", true, 0, 2}};
  EXPECT_EQ(imbalance_of(one_works), 2);
}

}  // namespace vantage::run_measurement_test
