#include "engine/profiling/profile_findings.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/made_up_profiles.h"

namespace vantage::profile_findings_test {

using Kind = ProfileFinding::Kind;

std::vector<Kind> kinds_of(const Profile& profile) {
  std::vector<Kind> kinds;
  for (const ProfileFinding& finding : profile_findings(profile)) {
    kinds.push_back(finding.kind);
  }
  return kinds;
}

std::string text_of(const Profile& profile, Kind kind) {
  for (const ProfileFinding& finding : profile_findings(profile)) {
    if (finding.kind == kind) {
      return finding.text;
    }
  }
  return "";
}

ProfileSample exactly(double value) { return {value, value, value}; }

// One thread, one stage of one second with a roof of 100 GFLOP/s, 50 GB/s from L2, 5 from memory.
Profile one_stage(double operations, double bytes) {
  Profile profile;
  profile.ceilings = {{1, 100, 100, 50, 50, 5, 5}};
  ThreadCountProfile count;
  StageProfile stage;
  stage.name = "cost";
  stage.seconds = exactly(1);
  stage.operations = operations;
  stage.bytes = bytes;
  count.stages = {stage};
  profile.thread_counts = {count};
  return profile;
}

TEST(ProfileFindings, NothingIsSaidOfNothing) {
  EXPECT_THAT(profile_findings({}), IsEmpty());
  Profile profile;
  profile.thread_counts.resize(1);
  EXPECT_THAT(profile_findings(profile), IsEmpty());
}

TEST(ProfileFindings, TheBoundOfAStageIsTheRoofItHalfReaches) {
  EXPECT_THAT(text_of(one_stage(50e9, 5e9), Kind::kStage),
              AllOf(HasSubstr("\"cost\" takes 100 % of the stages' time"),
                    HasSubstr("Arithmetic bounds it: 50 GFLOP/s are 50 %")));
  EXPECT_THAT(text_of(one_stage(12e9, 30e9), Kind::kStage),
              HasSubstr("level-2 cache bounds it: 30 GB/s are 60 %"));
  EXPECT_THAT(text_of(one_stage(49e9, 20e9), Kind::kStage),
              HasSubstr("It reaches 49 % of what the thread can calculate, so neither"));
  EXPECT_THAT(text_of(one_stage(1e9, 10e9), Kind::kStage),
              HasSubstr("It reaches 20 % of what its level-2 cache delivers, so neither"));
}

TEST(ProfileFindings, MemoryMayBoundWhatMovesAboutWhatMemoryDelivers) {
  EXPECT_THAT(text_of(one_stage(1e9, 4e9), Kind::kStage),
              HasSubstr("Memory may bound it: 4 GB/s are 80 %"));
  EXPECT_THAT(text_of(one_stage(1e9, 2.9e9), Kind::kStage), Not(HasSubstr("Memory")));
  EXPECT_THAT(text_of(one_stage(1e9, 5.6e9), Kind::kStage), Not(HasSubstr("Memory")));
}

TEST(ProfileFindings, WhatIsNotKnownIsNotGuessed) {
  EXPECT_THAT(text_of(one_stage(0, 0), Kind::kStage),
              HasSubstr("not known: it does not count its operations and bytes"));
  Profile profile = one_stage(50e9, 5e9);
  profile.ceilings.clear();
  EXPECT_THAT(text_of(profile, Kind::kStage), HasSubstr("ceilings were not measured"));
}

TEST(ProfileFindings, StagesAreComparedWithTheWorkOfThePool) {
  Profile profile = one_stage(50e9, 5e9);
  profile.thread_counts[0].workers = {{"main", true, 1.25, 0}, {"other", false, 7, 0}};
  EXPECT_THAT(text_of(profile, Kind::kStage), HasSubstr("takes 80 % of the work"));
}

TEST(ProfileFindings, ThePartIsNamedWhereStagesAreLessThanHalf) {
  Profile profile = one_stage(50e9, 5e9);
  ThreadCountProfile& count = profile.thread_counts[0];
  count.parts = {{"write", exactly(1.5), 3}, {"match left", exactly(1), 3}};
  count.workers = {{"main", true, 2, 0}};
  EXPECT_EQ(text_of(profile, Kind::kPart), "");
  count.workers = {{"main", true, 2.5, 0}};
  EXPECT_THAT(text_of(profile, Kind::kPart),
              AllOf(HasSubstr("only 40 % of the work"), HasSubstr("\"write\" with 1.5 s")));
}

TEST(ProfileFindings, WaitingIsNamedFromATwentiethOn) {
  Profile profile = one_stage(50e9, 5e9);
  ThreadCountProfile& count = profile.thread_counts[0];
  EXPECT_EQ(text_of(profile, Kind::kWaiting), "");  // no trace
  count.workers = {{"main", true, 9.6, 0.4}};
  count.work_share = exactly(0.96);
  EXPECT_THAT(text_of(profile, Kind::kWaiting), HasSubstr("work 96 % of the time"));
  count.workers = {{"main", true, 8, 2}};
  count.work_share = exactly(0.8);
  EXPECT_EQ(text_of(profile, Kind::kWaiting), "20 % of the threads' time is lost waiting.");
  count.waiting_for.writing_s = exactly(1.5);
  count.waiting_for.reading_s = exactly(0.5);
  EXPECT_THAT(
      text_of(profile, Kind::kWaiting),
      HasSubstr("20 % of the threads' time is lost waiting, most of it (15 %) while results "
                "were encoded or written"));
}

TEST(ProfileFindings, UnevenWorkIsNamedFromATenthOn) {
  Profile profile = one_stage(50e9, 5e9);
  profile.thread_counts[0].imbalance = exactly(1.09);
  EXPECT_EQ(text_of(profile, Kind::kImbalance), "");
  profile.thread_counts[0].imbalance = exactly(1.37);
  EXPECT_THAT(text_of(profile, Kind::kImbalance), HasSubstr("1.37 times the mean"));
}

TEST(ProfileFindings, HaloIsNamedFromATwentiethOfTheTimeOn) {
  Profile profile = one_stage(50e9, 5e9);
  StageProfile& stage = profile.thread_counts[0].stages[0];
  stage.columns = 100;
  stage.own_columns = 96;
  EXPECT_EQ(text_of(profile, Kind::kHalo), "");
  stage.own_columns = 80;  // a fifth of what is made
  EXPECT_THAT(text_of(profile, Kind::kHalo), HasSubstr("20 % of the stages' time makes columns"));
}

TEST(ProfileFindings, SpeedUpTellsTheSerialPart) {
  Profile profile = one_stage(50e9, 5e9);
  profile.speed_ups = {{1, exactly(1), 1, std::nullopt}};
  EXPECT_EQ(text_of(profile, Kind::kScaling), "");
  profile.speed_ups.push_back({4, exactly(3.2), 0.8, 0.083});
  EXPECT_EQ(text_of(profile, Kind::kScaling),
            "4 threads are 3.20 times as fast as one (efficiency 80 %).");
  profile.serial_fraction = 0.08;
  EXPECT_THAT(text_of(profile, Kind::kScaling),
              HasSubstr("a serial part of 8.0 %: more threads could make it at most 12.5 times"));
  profile.serial_fraction = -0.02;
  EXPECT_THAT(text_of(profile, Kind::kScaling), HasSubstr("no serial part is to be seen"));
  profile.serial_fraction = 1.07;
  EXPECT_THAT(text_of(profile, Kind::kScaling), HasSubstr("more threads are not faster"));
}

TEST(ProfileFindings, ComeInTheirOrder) {
  EXPECT_THAT(kinds_of(made_up_match()),
              ElementsAre(Kind::kStage, Kind::kWaiting, Kind::kHalo, Kind::kScaling));
  EXPECT_THAT(kinds_of(made_up_run()),
              ElementsAre(Kind::kStage, Kind::kWaiting, Kind::kImbalance, Kind::kScaling));
}

}  // namespace vantage::profile_findings_test
