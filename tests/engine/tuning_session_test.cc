#include "engine/tuning/tuning_session.h"

#include "tests/engine/engine_test.h"

namespace vantage::tuning_session_test {

TEST(TuneMachine, FindsSomethingToStoreInLittleTime) {
  TuningRequest request;
  request.match.method = MatchMethod::kSsd;  // the quickest
  request.match.disparities = {0, 15};
  request.execution.threads = 2;
  request.images = {120, 60, true};
  request.budget_seconds = 1;
  int calls = 0;
  const TuningReport report = tune_machine(
      request, [&](TunedUse, const TunerProgress&) { ++calls; }, nullptr);
  ASSERT_EQ(report.uses.size(), 2U);
  EXPECT_EQ(report.uses[0].use, TunedUse::kMatch);
  EXPECT_EQ(report.uses[1].use, TunedUse::kRun);
  EXPECT_EQ(calls, report.uses[0].outcome.measurements + report.uses[1].outcome.measurements);
  const TuningEntry entry = entry_of(report, "today");
  ASSERT_TRUE(entry.match);
  EXPECT_GT(entry.match->frame_seconds, 0);
  EXPECT_EQ(entry.match->date, "today");
  EXPECT_NO_THROW(entry.match->settings.validate());
}

TEST(TuneMachine, StoresNothingOfAnInterruptedSearch) {
  TuningRequest request;
  request.images = {120, 60, true};
  request.match.disparities = {0, 15};
  std::atomic<bool> stop = false;
  const TuningReport report = tune_machine(
      request, [&](TunedUse, const TunerProgress&) { stop = true; }, &stop);
  EXPECT_TRUE(report.interrupted);
  const TuningEntry entry = entry_of(report, "today");
  EXPECT_FALSE(entry.match);
  EXPECT_FALSE(entry.run);
}

TEST(TuneMachine, RefusesWhatCannotBe) {
  TuningRequest request;
  for (const TunedImages images :
       {TunedImages{0, 10}, TunedImages{10, -1}, TunedImages{20000, 9}}) {
    request.images = images;
    EXPECT_THROW(tune_machine(request, {}, nullptr), UsageError);
  }
  request.images = {100, 100};
  request.budget_seconds = 1e9;
  EXPECT_THROW(request.validate(), UsageError);
  request.budget_seconds = 0;
  EXPECT_THROW(tune_machine(request, {}, nullptr), UsageError);
  request.budget_seconds = 1;
  request.match.disparities = {200, 300};
  EXPECT_THROW(tune_machine(request, {}, nullptr), Error);
}

}  // namespace vantage::tuning_session_test
