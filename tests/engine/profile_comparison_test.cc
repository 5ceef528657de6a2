#include "engine/profiling/profile_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/profiling/stage_figures.h"

namespace vantage {
namespace profile_comparison_test {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

Profile made_up() {
  ThreadCountProfile count;
  count.threads = 2;
  count.runs = 5;
  count.wall_s = {2.0, 1.9, 2.1};
  count.compute_s = {1.0, 0.9, 1.1};
  count.peak_memory_bytes = {1e6, 1e6, 1e6};
  StageProfile stage;
  stage.name = "cost";
  stage.seconds = {0.5, 0.4, 0.6};
  count.stages.push_back(stage);
  Profile profile;
  profile.processor = "P";
  profile.isa = "AVX2";
  profile.command = "vantage match";
  profile.thread_counts.push_back(count);
  return profile;
}

const ComparedFigure& figure(const ProfileComparison& comparison, const std::string& name) {
  return *std::ranges::find(comparison.figures, name, &ComparedFigure::name);
}

TEST(CompareProfiles, SeesNoDifferenceWhereRangesOverlap) {
  Profile slower = made_up();
  slower.thread_counts[0].wall_s = {2.3, 2.1, 2.5};  // they meet at 2.1
  const ProfileComparison comparison = compare_profiles(made_up(), slower);
  EXPECT_THAT(comparison.warnings, IsEmpty());
  ASSERT_EQ(comparison.figures.size(), 4U);
  EXPECT_EQ(figure(comparison, "wall").verdict, Verdict::kNoDifference);
  EXPECT_EQ(verdict_text(figure(comparison, "wall")), "no difference seen");
  EXPECT_NEAR(figure(comparison, "wall").ratio(), 1.15, 1e-12);
  // Nor where a median lies outside of the other range.
  Profile faster = made_up();
  faster.thread_counts[0].wall_s = {1.5, 1.0, 1.95};
  EXPECT_EQ(figure(compare_profiles(made_up(), faster), "wall").verdict, Verdict::kNoDifference);
  EXPECT_EQ(figure(compare_profiles(faster, made_up()), "wall").verdict, Verdict::kNoDifference);
}

TEST(CompareProfiles, TellsFasterFromSlower) {
  Profile other = made_up();
  other.thread_counts[0].wall_s = {1.0, 0.9, 1.89};
  other.thread_counts[0].stages[0].seconds = {0.75, 0.61, 0.8};
  other.thread_counts[0].peak_memory_bytes = {5e5, 5e5, 5e5};
  const ProfileComparison comparison = compare_profiles(made_up(), other);
  EXPECT_EQ(verdict_text(figure(comparison, "wall")), "2.00x faster");
  EXPECT_EQ(verdict_text(figure(comparison, "stage cost")), "1.50x slower");
  EXPECT_EQ(verdict_text(figure(comparison, "peak memory")), "2.00x smaller");
  EXPECT_EQ(figure(comparison, "compute").verdict, Verdict::kNoDifference);
  const ProfileComparison back = compare_profiles(other, made_up());
  EXPECT_EQ(verdict_text(figure(back, "wall")), "2.00x slower");
}

TEST(CompareProfiles, WantsThreeRunsForAVerdict) {
  Profile other = made_up();
  other.thread_counts[0].runs = 2;
  other.thread_counts[0].wall_s = {1, 1, 1};
  const ProfileComparison comparison = compare_profiles(made_up(), other);
  EXPECT_EQ(verdict_text(figure(comparison, "wall")), "too few runs");
}

TEST(CompareProfiles, WarnsWhereTheyAreOfDifferentThings) {
  Profile other = made_up();
  other.processor = "Q";
  other.isa = "SSE4";
  other.command = "vantage run";
  other.hardware_threads = 64;
  other.thread_counts[0].stages[0].name = "membrane";
  other.thread_counts.push_back(other.thread_counts[0]);
  other.thread_counts.back().threads = 4;
  const ProfileComparison comparison = compare_profiles(made_up(), other);
  for (const char* what :
       {"processor differs: P and Q", "instruction set", "command", "threads", "hardware threads",
        "stage cost is in the first alone", "stage membrane is in the second alone"}) {
    EXPECT_THAT(comparison.warnings, Contains(HasSubstr(what)));
  }
  EXPECT_EQ(comparison.figures.size(), 3U);  // of two threads, without the stages
  other.thread_counts.erase(other.thread_counts.begin());
  EXPECT_THAT(compare_profiles(made_up(), other).figures, IsEmpty());
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

}  // namespace profile_comparison_test
}  // namespace vantage
