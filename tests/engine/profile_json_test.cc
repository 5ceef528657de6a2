// The JSON of a profile holds every field, and what is computed for those who show it.

#include "engine/profiling/profile_json.h"

#include <nlohmann/json.hpp>

#include "tests/engine/engine_test.h"
#include "tests/engine/made_up_profiles.h"

namespace vantage::profile_json_test {

using nlohmann::json;

json json_of(const Profile& profile) { return json::parse(profile_json(profile)); }

TEST(ProfileJson, HoldsEveryField) {
  Profile profile = made_up_run();
  const json document = json_of(profile);
  for (const char* const key :
       {"profile_schema", "version", "command", "date", "processor", "isa", "hardware_threads",
        "peak_memory_bytes", "serial_fraction", "timeline_s"}) {
    EXPECT_TRUE(document.contains(key)) << key;
  }
  const json& count = document.at("thread_counts")[1];
  const ThreadCountProfile& expected = profile.thread_counts[1];
  EXPECT_EQ(count.at("threads"), expected.threads);
  EXPECT_EQ(count.at("frames_per_s").at("median"), expected.frames_per_s.median);
  EXPECT_EQ(count.at("stages")[1].at("own_columns"), expected.stages[1].own_columns);
  EXPECT_EQ(count.at("parts")[2].at("count"), expected.parts[2].count);
  EXPECT_EQ(count.at("waits")[0].at("name"), expected.waits[0].name);
  EXPECT_EQ(count.at("waiting_for").at("nothing_s").at("most"), expected.waiting_for.nothing_s.max);
  EXPECT_EQ(count.at("workers")[0].at("is_in_pool"), true);
  EXPECT_EQ(document.at("speed_ups")[1].at("ratio").at("median"),
            profile.speed_ups[1].ratio.median);
  EXPECT_EQ(document.at("ceilings")[0].at("core_gflops"), profile.ceilings[0].core_gflops);
  EXPECT_EQ(document.at("memory").size(), profile.memory.size());
  EXPECT_EQ(document.at("timeline")[3].at("spans")[0].at("end_s"),
            profile.timeline[3].spans[0].end_s);
}

TEST(ProfileJson, HoldsFiguresOfStages) {
  const json count = json_of(made_up_match()).at("thread_counts")[1];
  const json& roofs = count.at("roofs");
  EXPECT_DOUBLE_EQ(roofs.at("gflops"), 118);
  EXPECT_DOUBLE_EQ(roofs.at("l2_gb_per_s"), 136);
  EXPECT_NEAR(roofs.at("memory_gb_per_s"), 9.75, 0.01);
  EXPECT_NEAR(count.at("pool_work_s"), 0.56, 1e-9);
  EXPECT_NEAR(count.at("pool_time_s"), 0.64, 1e-9);
  const json& stage = count.at("stages")[0];  // 164e6 cells of 11 operations and 12 bytes
  EXPECT_NEAR(stage.at("work_share"), 0.402 / 0.56, 1e-9);
  EXPECT_NEAR(stage.at("ns_per_cell"), 402.0 / 164, 1e-9);
  EXPECT_NEAR(stage.at("cells_per_s"), 164e6 / 0.402, 1);
  EXPECT_NEAR(stage.at("halo_share"), 0.0675, 1e-9);
  EXPECT_NEAR(stage.at("gb_per_s"), 0.164 * 12 / 0.402, 1e-9);
  EXPECT_NEAR(stage.at("gflops"), 0.164 * 11 / 0.402, 1e-9);
  const json& place = stage.at("roofline");
  EXPECT_EQ(place.at("roof"), "arithmetic");
  EXPECT_DOUBLE_EQ(place.at("operations_per_byte"), 11.0 / 12);
  EXPECT_DOUBLE_EQ(place.at("roof_gflops"), 118);
  EXPECT_NEAR(place.at("roof_share"), 0.164 * 11 / 0.402 / 118, 1e-9);
  EXPECT_NEAR(place.at("memory_share"), 4.896 / 9.748, 1e-3);
}

TEST(ProfileJson, HoldsWhatIsSaidOfTheFigures) {
  Profile profile = made_up_run();
  profile.advice = {"--preset realtime"};
  const json document = json_of(profile);
  EXPECT_EQ(document.at("advice"), json::array({"--preset realtime"}));
  EXPECT_GE(document.at("findings").size(), 3U);
}

TEST(ProfileJson, UnknownFiguresAreNull) {
  Profile profile = made_up_match();
  profile.ceilings.clear();
  profile.thread_counts[0].wall_s.max = std::numeric_limits<double>::infinity();
  profile.command = "\xFF";  // no UTF-8
  const json document = json_of(profile);
  EXPECT_TRUE(document.at("thread_counts")[0].at("roofs").is_null());
  EXPECT_TRUE(document.at("thread_counts")[0].at("stages")[0].at("roofline").is_null());
  EXPECT_TRUE(document.at("thread_counts")[0].at("wall_s").at("most").is_null());
  EXPECT_EQ(json_of({}).at("findings"), json::array());
}

}  // namespace vantage::profile_json_test
