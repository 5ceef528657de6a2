#include "engine/profiling/profile_advice.h"

#include "tests/engine/engine_test.h"

namespace vantage::profile_advice_test {

Profile on_threads(const std::vector<std::pair<int, double>>& wall_s, int hardware_threads) {
  Profile profile;
  profile.hardware_threads = hardware_threads;
  for (const auto& [threads, seconds] : wall_s) {
    ThreadCountProfile& count = profile.thread_counts.emplace_back();
    count.threads = threads;
    count.wall_s = {seconds, seconds, seconds};
  }
  return profile;
}

const std::map<std::string, double> kSteps = {{"read", 0.01},       {"range", 0.2},
                                              {"check", 0.1},       {"match left", 0.35},
                                              {"match right", 0.3}, {"write", 0.04}};

TEST(ProfileAdvice, NothingIsSaidOfNothing) { EXPECT_THAT(profile_advice({}, {}, {}), IsEmpty()); }

TEST(ProfileAdvice, WhatSavesMostComesFirst) {
  const Profile profile = on_threads({{1, 3}, {2, 1.6}, {4, 1}}, 4);
  const ProfiledChoices choices{.preset = MatchPreset::kBalanced,
                                .estimates_range = true,
                                .checks_rows = true,
                                .has_map_for_check_only = true};
  EXPECT_THAT(
      profile_advice(profile, kSteps, choices),
      ElementsAre(HasSubstr("--preset realtime: maps take 650 ms, 65 % of the time of all steps"),
                  HasSubstr("--cross-check none: a second map is made only to check the first, "
                            "which takes 300 ms, 30 %"),
                  HasSubstr("--disparities MIN:MAX, the range that 'auto' prints: looking for it "
                            "takes 200 ms, 20 %"),
                  HasSubstr("--no-rectification-check, where rows are known to correspond: looking "
                            "at them takes 100 ms, 10 %")));
}

TEST(ProfileAdvice, OnlyWhatTheCommandCouldDoIsSaid) {
  const Profile profile = on_threads({{4, 1}}, 4);
  // The fastest preset, a known range, no look at rows, both maps wanted.
  EXPECT_THAT(profile_advice(profile, kSteps, {.preset = MatchPreset::kRealtime, .candidates = 32}),
              IsEmpty());
  EXPECT_THAT(
      profile_advice(profile, kSteps, {.preset = MatchPreset::kRealtime, .candidates = 256}),
      ElementsAre(HasSubstr("256 candidates are searched in 650 ms")));
  EXPECT_THAT(profile_advice(profile, kSteps, {.preset = {}, .candidates = 32}),
              ElementsAre(HasSubstr("--preset realtime instead of a method of Scharstein's book")));
  // realtime searches 16 candidates at full size.
  EXPECT_THAT(profile_advice(profile, kSteps, {.preset = {}, .candidates = 16}),
              ElementsAre(HasSubstr("--preset balanced instead of a method of Scharstein's book")));
  EXPECT_THAT(profile_advice(profile, kSteps, {.preset = MatchPreset::kBalanced, .candidates = 16}),
              IsEmpty());
  // What takes less than a twentieth is not worth a word.
  EXPECT_THAT(profile_advice(profile, {{"check", 0.04}, {"write", 0.96}},
                             {.preset = MatchPreset::kRealtime, .checks_rows = true}),
              IsEmpty());
}

TEST(ProfileAdvice, ThreadsThatGainNothingAreNamed) {
  const ProfiledChoices choices{.preset = MatchPreset::kRealtime};
  EXPECT_THAT(profile_advice(on_threads({{1, 2}, {2, 1}, {4, 1.02}, {8, 1.2}}, 8), {}, choices),
              ElementsAre(HasSubstr("--threads 2: 1 s, with 8 threads 1.2 s")));
  EXPECT_THAT(profile_advice(on_threads({{1, 2}, {2, 1}}, 8), {}, choices),
              ElementsAre(HasSubstr("--threads 8: the machine has as many, at most 2 were")));
  EXPECT_THAT(profile_advice(on_threads({{1, 2}, {2, 1}}, 2), {}, choices), IsEmpty());
}

}  // namespace vantage::profile_advice_test
