// vantage profile: what it keeps of a pair's and a sequence's runs, and that it leaves nothing
// else.

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"

namespace vantage::command_profile_test {

using nlohmann::json;

Words keys_of(const json& object) {
  Words keys;
  for (const auto& [key, value] : object.items()) {
    keys.push_back(key);
  }
  std::ranges::sort(keys);
  return keys;
}

class ProfileTest : public PairTest {
 protected:
  /// `profile --runs 1 --json … MORE`, and the command behind it.
  [[nodiscard]] ProcessResult profile(const Words& more, const Words& command) const {
    const Words own = {"profile", "--runs", "1", "--json", json_};
    return run_vantage(joined(joined(own, more), command));
  }
  [[nodiscard]] Words match_command(const Words& more = {}) const {
    return joined({"match", left_, right_, "-o", out_ / "map.pfm", "--disparities=0:9"}, more);
  }

  TemporaryFolder out_;  // of the profiled command
  std::string json_ = folder_ / "profile.json";
};

using SlowProfileTest = ProfileTest;

TEST_F(SlowProfileTest, KeepsWhereTheTimeOfAPairGoes) {
  const std::string page = folder_ / "profile.html";
  const ProcessResult result =
      succeeds(profile({"--threads", "2,1", "--html", page},
                       match_command({"--method", "ssd", "--unmatched", out_ / "m.png"})));
  EXPECT_LT(result.out.find("What you can do about the time\n"),
            result.out.find("What holds it back\n"));
  for (const char* text : {"Threads", "speed-up", "column SSD", "Work and waiting",
                           "What the machine", "level 2", "Memory", "idle"}) {
    EXPECT_THAT(result.out, HasSubstr(text));
  }
  const json kept = read_json(json_);
  EXPECT_EQ(kept.at("profile_schema"), 1);
  EXPECT_THAT(kept.at("command"), HasSubstr("vantage match " + left_));
  EXPECT_THAT(kept.at("date"), MatchesRegex(".*-..-..T..:..:..Z"));
  EXPECT_GT(kept.at("peak_memory_bytes"), 1'000'000);
  std::set<std::string> owners;
  for (const json& owner : kept.at("memory")) {
    owners.insert(owner.at("name").get<std::string>());
    EXPECT_LE(owner.at("bytes"), kept.at("peak_memory_bytes")) << owner;
  }
  for (const char* owner : {"program", "photographs", "maps", "rings"}) {
    EXPECT_EQ(owners.count(owner), 1U) << owner;
  }
  ASSERT_EQ(kept.at("thread_counts").size(), 2U);
  ASSERT_EQ(kept.at("ceilings").size(), 2U);
  for (int i = 0; i < 2; ++i) {
    const json& count = kept.at("thread_counts")[i];
    EXPECT_EQ(count.at("threads"), i + 1);
    EXPECT_EQ(count.at("runs"), 1);
    EXPECT_GT(count.at("wall_s").at("median"), count.at("compute_s").at("median"));
    EXPECT_EQ(count.at("frames_per_s").at("median"), 0);
    EXPECT_EQ(kept.at("ceilings")[i].at("threads"), i + 1);
    EXPECT_GT(kept.at("ceilings")[i].at("all_gflops"), 0);
    // The table above leaves out what is short beside the start of a program on a busy machine.
    EXPECT_TRUE(std::ranges::any_of(
        count.at("parts"), [](const json& part) { return part.at("name") == "match left"; }));
    // Stages count what they make, whatever the number of threads.
    const json& stage = count.at("stages")[0];
    EXPECT_EQ(keys_of(stage), (Words{"bytes", "cells", "cells_per_s", "columns", "gb_per_s",
                                     "gflops", "halo_share", "name", "ns_per_cell", "operations",
                                     "own_columns", "roofline", "seconds", "work_share"}));
    EXPECT_GE(stage.at("columns"), stage.at("own_columns"));
    double pool_s = 0;
    for (const json& worker : count.at("workers")) {
      if (worker.at("is_in_pool").get<bool>()) {
        pool_s += worker.at("work_s").get<double>() + worker.at("wait_s").get<double>();
      }
    }
    EXPECT_NEAR(std::remainder(pool_s, count.at("wall_s").at("median").get<double>()), 0, 1e-3);
  }
  const json& growth = kept.at("processor_growth");
  const auto left =
      std::ranges::find_if(growth, [](const json& one) { return one.at("name") == "match left"; });
  ASSERT_NE(left, growth.end());
  EXPECT_EQ(left->at("ms").size(), 2U);
  EXPECT_EQ(left->at("growth")[0], 0);
  EXPECT_THAT(result.out, HasSubstr("growth"));
  EXPECT_EQ(kept.at("speed_ups")[0].at("ratio").at("median"), 1);
  EXPECT_TRUE(kept.at("speed_ups")[0].at("serial_fraction").is_null());
  EXPECT_TRUE(kept.at("serial_fraction").is_number());
  EXPECT_FALSE(kept.at("timeline").empty());
  EXPECT_FALSE(kept.at("advice").empty());
  EXPECT_THAT(read_file(page), AllOf(HasSubstr("<html"), HasSubstr(read_file(json_))));
  EXPECT_EQ(out_.entries(), 0U);
}

TEST_F(SlowProfileTest, LeavesResultsThatAreThere) {
  write_file(out_ / "map.pfm", "mine");
  succeeds(profile({"--threads", "1"}, match_command()));
  EXPECT_EQ(read_file(out_ / "map.pfm"), "mine");
  EXPECT_EQ(out_.entries(), 1U);
}

using InputProfileCommand = ProfileTest;

TEST_F(InputProfileCommand, PassesOnWhatAFailingRunSays) {
  write_file(left_, "no image");
  expect_one_line(profile({"--quiet", "--threads", "1"}, match_command()), 1, "match", left_);
  EXPECT_EQ(out_.entries(), 0U);
  EXPECT_FALSE(fs::exists(json_));
}

TEST_F(InputProfileCommand, RefusesWhatItCannotProfile) {
  const auto refused = [&](const Words& own, const Words& command, const char* text) {
    expect_one_line(profile(own, command), 2, "profile", text);
    EXPECT_EQ(out_.entries(), 0U);
  };
  refused({}, {"synth", left_, right_}, "'synth' cannot be profiled, expected match or run");
  refused({}, {}, "a command is missing");
  refused({}, match_command({"--report", folder_ / "r.json"}), "--report cannot be profiled");
  refused({}, match_command({"--trace", folder_ / "t.json"}), "--trace cannot be profiled");
  refused({}, match_command({"--methud", "ssd"}), "'--method'");
  refused({}, {"match", left_, right_, "--disparities=0:9"}, "--output is missing");
  refused({"--runs=0"}, match_command(), "times");  // given twice
  refused({"--threads", "0"}, match_command(), "threads is 0");
  refused({"--budget", "-1"}, match_command(), "--budget is -1");
  refused({"--html", folder_ / "page.txt"}, match_command(), "--html");
  EXPECT_FALSE(fs::exists(json_));
}

TEST_F(SlowProfileTest, EndsWithTheBudgetButMakesARound) {
  const ProcessResult result = succeeds(run_vantage(
      joined({"profile", "--runs", "50", "--budget", "0.001", "--threads", "1", "--json", json_},
             match_command())));
  EXPECT_THAT(result.err, HasSubstr("the budget ended it after 1 of 50 rounds"));
  EXPECT_EQ(read_json(json_).at("thread_counts")[0].at("runs"), 1);
}

TEST_F(SlowProfileTest, EndsCleanlyWhenInterrupted) {
  const TemporaryFolder streams;
  const VantageProcess process(
      joined({"profile", "--runs", "1000", "--threads", "1", "--json", json_}, match_command()),
      streams.path());
  while (out_.entries() == 0 && !process.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  process.send(SIGTERM);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted, nothing is kept"));
  EXPECT_EQ(out_.entries(), 0U);
  EXPECT_FALSE(fs::exists(json_));
}

TEST_F(ProfileTest, AnswersHelpOfBoth) {
  const ProcessResult own = succeeds(run_vantage({"profile", "--help"}));
  EXPECT_THAT(own.out, AllOf(HasSubstr("--budget"), HasSubstr("match|run")));
  const ProcessResult of_match = succeeds(run_vantage({"profile", "match", "--help"}));
  EXPECT_THAT(of_match.out, HasSubstr("--disparities"));
}

/// Of a sequence, in a folder that holds a finished run.
class SlowProfiledRun : public RunTest {
 protected:
  SlowProfiledRun() {
    succeeds(run(out_, {"--frames", "0-2"}));
    before_ = results_in(out_);
    entries_ = folder_.entries();
  }

  void expect_untouched() const {
    EXPECT_TRUE(same_files(results_in(out_), before_));
    EXPECT_EQ(folder_.entries(), entries_ + 1);  // and the profile
    EXPECT_FALSE(fs::exists(out_ + "/profile.json"));
  }

  [[nodiscard]] json profiled(const Words& command) const {
    const std::string kept = folder_ / "profile.json";
    const ProcessResult result = succeeds(
        run_vantage(joined({"profile", "--runs", "1", "--threads", "2", "--json", kept}, command)));
    return result.exit_code == 0 ? read_json(kept) : json();
  }

  std::string out_ = folder_ / "out";
  FolderContent before_;
  std::size_t entries_ = 0;
};

TEST_F(SlowProfiledRun, BeginsAnewAndLeavesTheFolderAlone) {
  const json kept = profiled(arguments(out_, {"--resume", "--save", "disparity"}));
  const json& count = kept.at("thread_counts")[0];
  EXPECT_GT(count.at("frames_per_s").at("median"), 0);
  const auto decode = std::ranges::find_if(
      count.at("parts"), [](const json& part) { return part.at("name") == "decode"; });
  ASSERT_NE(decode, count.at("parts").end());
  EXPECT_EQ(decode->at("count"), kFrames);  // all frames, not those that are left
  const json& growth = kept.at("processor_growth");
  for (const char* step : {"read", "decode", "match", "encode"}) {
    EXPECT_TRUE(std::ranges::any_of(growth, [&](const json& one) {
      return one.at("kind") == "step" && one.at("name") == step && one.at("ms")[0] > 0;
    })) << step;
  }
  EXPECT_TRUE(kept.at("serial_fraction").is_null());
  expect_untouched();
}

TEST_F(SlowProfiledRun, IsEndedWithTheProfile) {
  const TemporaryFolder streams;
  const VantageProcess process(
      joined({"profile", "--runs", "1000", "--threads", "1", "--json", folder_ / "profile.json"},
             arguments(out_)),
      streams.path());
  const auto a_run_is_under_way = [&] {
    std::error_code ignored;
    return std::ranges::any_of(fs::directory_iterator(folder_.path()), [&](const auto& entry) {
      return fs::exists(entry.path() / "out" / ".vantage", ignored);
    });
  };
  while (!a_run_is_under_way() && !process.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.send(SIGTERM);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_TRUE(same_files(results_in(out_), before_));
  EXPECT_EQ(folder_.entries(), entries_);
}

TEST_F(SlowProfiledRun, TakesAJobFile) {
  const TemporaryFolder jobs;
  write_file(jobs / "job.toml", "left = \"" + left_ + "\"\nright = \"" + right_ +
                                    "\"\noutput = \"" + out_ +
                                    "\"\ndisparities = \"0:9\"\nframes = \"0-4\"\n");
  const json kept = profiled({"run", jobs / "job.toml"});
  const auto& parts = kept.at("thread_counts")[0].at("parts");
  const auto decode =
      std::ranges::find_if(parts, [](const json& part) { return part.at("name") == "decode"; });
  ASSERT_NE(decode, parts.end());
  EXPECT_EQ(decode->at("count"), 5);
  expect_untouched();
}

}  // namespace vantage::command_profile_test
