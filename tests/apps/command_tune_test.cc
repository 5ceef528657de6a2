#include "engine/tuning/tuning_file.h"
#include "engine/tuning/tuning_key.h"
#include "scheduler/machine.h"
#include "tests/apps/sampling.h"

namespace vantage::command_tune_test {

/// A pair and a configuration folder of its own.
class TuneTest : public PairTest {
 protected:
  [[nodiscard]] ProcessResult run(const Words& arguments) const {
    return run_vantage(arguments, {"XDG_CONFIG_HOME=" + config_});
  }
  [[nodiscard]] ProcessResult tune(const Words& more = {}) const {
    Words arguments = {"tune", "--size", "71x53", "--disparities=0:9", "--budget", "0.4"};
    return run(with_method(arguments, more));
  }
  [[nodiscard]] ProcessResult match_tuned(const Words& more = {}) const {
    Words arguments = {"match",    left_,  right_, "-o", folder_ / "map.pfm", "--disparities=0:9",
                       "--report", report_};
    return run(with_method(arguments, more));
  }
  /// With `more`, and with SSD unless that names a method.
  static Words with_method(const Words& arguments, const Words& more) {
    const bool has_method = std::ranges::find(more, "--method") != more.end();
    return joined(joined(arguments, more), has_method ? Words{} : Words{"--method", "ssd"});
  }
  [[nodiscard]] nlohmann::json report() const { return read_json(report_); }

  /// The key that `match` looks for with the pair of this test.
  [[nodiscard]] TuningKey key(const ExecutionOptions& execution = {},
                              MatchMethod method = MatchMethod::kSsd) const {
    MatchOptions match;
    match.method = method;
    match.disparities = {0, 9};
    return make_tuning_key(scheduler::detect_machine(), match, execution,
                           {pair_.left.width(), pair_.left.height(), pair_.left.channels() == 1});
  }
  void store(const TuningKey& key, const TunedSettings& settings) const {
    TuningEntry entry;
    entry.key = key;
    entry.match = TunedPlan{.settings = settings};
    entry.run = TunedPlan{.settings = settings};
    store_entry(file_, entry);
  }

  std::string config_ = folder_ / "config";
  fs::path file_ = fs::path(config_) / "vantage" / "tuning.json";
  std::string report_ = folder_ / "report.json";
  /// Not what any cost model would choose.
  TunedSettings odd_ = {.threads = 3, .strip_width_px = 7, .band_height_px = 5};
};

using SlowTuneTest = TuneTest;

TEST_F(SlowTuneTest, FindsStoresAndTells) {
  const ProcessResult result = succeeds(tune({"--report", report_, "--images", "grey"}));
  EXPECT_THAT(result.out, HasSubstr("squared box about 8 px, 8-bit grey"));
  EXPECT_THAT(result.out, HasSubstr("median ms"));
  EXPECT_THAT(result.out, HasSubstr("saved in " + file_.string()));
  const TuningFileContent content = read_tuning_file(file_);
  ASSERT_EQ(content.entries.size(), 1U);
  ASSERT_TRUE(content.entries[0].match);
  EXPECT_TRUE(content.entries[0].run);
  const nlohmann::json json = report();
  EXPECT_EQ(json["command"], "tune");
  EXPECT_EQ(json["results"]["key"], content.entries[0].key.text());
  EXPECT_EQ(json["results"]["match"]["tried"][0]["settings"], nlohmann::json::object());
  EXPECT_GT(json["results"]["match"]["frame_seconds"], 0);
  EXPECT_GE(json["results"]["match"]["final_noise"], 0);
  EXPECT_TRUE(json["results"].contains("processors_used_by_others"));

  const ProcessResult list = succeeds(run({"tune", "--list"}));
  EXPECT_THAT(list.out, HasSubstr("1 entry"));
  EXPECT_THAT(list.out, HasSubstr(content.entries[0].key.machine));
  // The entry is what match then looks for.
  succeeds(match_tuned());
  EXPECT_EQ(report()["tuning"]["key"], content.entries[0].key.text());
}

TEST_F(SlowTuneTest, TunesOneUse) {
  succeeds(tune({"--for", "match"}));
  EXPECT_FALSE(read_tuning_file(file_).entries.at(0).run);
}

TEST_F(TuneTest, DryRunTellsAndStoresNothing) {
  const ProcessResult result = succeeds(tune({"--dry-run"}));
  EXPECT_THAT(result.out, HasSubstr(file_.string()));
  EXPECT_FALSE(fs::exists(config_));
}

TEST_F(SlowTuneTest, AnUnwritableFileFailsAfterTheResultsAreShown) {
  write_file(config_, "a file");
  const ProcessResult result = tune();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("median ms"));
  EXPECT_THAT(result.err, HasSubstr("cannot create the folder"));
}

using InputTuneCommand = TuneTest;

TEST_F(InputTuneCommand, RefusesWrongUsage) {
  const std::vector<Refusal> refusals = {
      {{"tune"}, "--size is missing"},
      {{"tune", "--size", "71"}, "--size is '71', expected WxH"},
      {{"tune", "--size", "71x-3"}, "size is 71x-3"},
      {{"tune", "--size", "71x53", "--disparities=auto"}, "--disparities is auto"},
      {{"tune", "--size", "71x53", "--budget", "-1"}, "budget is -1"},
      {{"tune", "--size", "71x53", "--window", "4"}, "window is 4"},
      {{"tune", "--list", "--budget", "5"}, "--budget has no effect with --list"}};
  expect_refusals("tune", folder_.path(), refusals, [&](const Words& words) { return run(words); });
}

TEST_F(TuneTest, MatchUsesItsEntryAndTheMapIsTheSame) {
  for (const auto& [name, method] :
       {std::pair("ssd", MatchMethod::kSsd), std::pair("bayes", MatchMethod::kBayes)}) {
    succeeds(match_tuned({"--no-tuning", "--method", name}));
    const std::string expected = read_file(folder_ / "map.pfm");
    EXPECT_EQ(report()["tuning"]["key"], nullptr);
    EXPECT_EQ(report()["tuning"]["reason"], "--no-tuning");

    TunedSettings settings = odd_;
    settings.iterations_per_pass = 3;
    store(key({}, method), settings);
    const ProcessResult result = succeeds(match_tuned({"--method", name}));
    EXPECT_THAT(result.err, HasSubstr("tuned: threads 3, strip-width 7"));
    EXPECT_EQ(read_file(folder_ / "map.pfm"), expected);
    const nlohmann::json json = report();
    EXPECT_EQ(json["tuning"]["key"], key({}, method).text());
    EXPECT_EQ(json["tuning"]["file"], file_.string());
    EXPECT_EQ(json["threads"], 3);
    EXPECT_EQ(json["plan"]["passes"][0]["strip_width_px"], 7);
    EXPECT_EQ(json["plan"]["passes"][0]["band_height_px"], 5);
  }
}

TEST_F(TuneTest, GivenOptionsGoFirst) {
  store(key(), odd_);
  succeeds(match_tuned({"--strip-width", "11"}));
  EXPECT_EQ(report()["plan"]["passes"][0]["strip_width_px"], 11);
  EXPECT_EQ(report()["plan"]["passes"][0]["band_height_px"], 5);
  EXPECT_FALSE(report()["tuning"]["settings"].contains("strip-width"));
  // Another number of threads is other work.
  succeeds(match_tuned({"--threads", "1"}));
  EXPECT_EQ(report()["threads"], 1);
  EXPECT_EQ(report()["tuning"]["key"], nullptr);
  store(key({.threads = 1}), {.strip_width_px = 13});
  succeeds(match_tuned({"--threads", "1"}));
  EXPECT_EQ(report()["plan"]["passes"][0]["strip_width_px"], 13);
}

TEST_F(TuneTest, WithoutAnEntryTheReportSaysWhatWasWanted) {
  succeeds(match_tuned());
  EXPECT_EQ(report()["tuning"]["wanted"], key().text());
  EXPECT_EQ(report()["tuning"]["reason"], "no entry for this work");
}

TEST_F(InputTuneCommand, ADamagedFileIsAWarning) {
  fs::create_directories(file_.parent_path());
  write_file(file_, "{ damaged");
  ProcessResult result = succeeds(match_tuned());
  EXPECT_THAT(result.err, HasSubstr("match: warning: tuning is not used: " + file_.string()));
  EXPECT_THAT(report()["tuning"]["reason"].get<std::string>(), HasSubstr("not JSON"));
  result = match_tuned({"--quiet"});
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(tune().exit_code, 1);
  EXPECT_EQ(read_file(file_), "{ damaged");
}

TEST_F(SlowTuneTest, AnotherFileCanBeNamed) {
  const std::string other = folder_ / "cluster.json";
  succeeds(tune({"--output", other, "--for", "match", "--images", "grey"}));
  EXPECT_FALSE(fs::exists(config_));
  succeeds(match_tuned({"--tuning", other}));
  EXPECT_EQ(report()["tuning"]["file"], other);
  const ProcessResult result = succeeds(match_tuned({"--tuning", folder_ / "none.json"}));
  EXPECT_THAT(result.err, HasSubstr("no such file"));
}

TEST_F(TuneTest, RunUsesItsEntryAndTheFilesAreTheSame) {
  for (const std::string side : {"left", "right"}) {
    fs::create_directory(folder_ / (side + "s"));
    for (const std::string frame : {"0.png", "1.png", "2.png"}) {
      fs::copy_file(folder_ / (side + ".png"), fs::path(folder_ / (side + "s")) / frame);
    }
  }
  const auto run_sequence = [&](const std::string& out, const Words& more) {
    Words arguments = {"run", "--left",      folder_ / "lefts",   "--right",  folder_ / "rights",
                       "-o",  folder_ / out, "--disparities=0:9", "--report", report_};
    return run(with_method(arguments, more));
  };
  ProcessResult result = succeeds(run_sequence("plain", {"--no-tuning"}));
  EXPECT_EQ(report()["tuning"]["reason"], "--no-tuning");

  TunedSettings settings = odd_;
  settings.frames_in_flight = 2;
  store(key(), settings);
  result = succeeds(run_sequence("tuned", {}));
  EXPECT_THAT(result.err, HasSubstr("3 threads (tbb), 2 frames in flight"));
  EXPECT_THAT(result.err, HasSubstr("run: tuned: threads 3, in-flight 2, strip-width 7"));
  EXPECT_EQ(report()["tuning"]["key"], key().text());
  EXPECT_EQ(report()["threads"], 3);
  for (const std::string frame : {"000000.pfm", "000001.pfm", "000002.pfm"}) {
    EXPECT_EQ(read_file(fs::path(folder_ / "tuned") / "disparity" / frame),
              read_file(fs::path(folder_ / "plain") / "disparity" / frame));
  }
  // Options go first, and a limit of memory is planned for without a tuned plan.
  result = run_sequence("given", {"--in-flight", "4"});
  EXPECT_THAT(result.err, HasSubstr("4 frames in flight"));
  result = succeeds(run_sequence("limited", {"--memory", "2G"}));
  EXPECT_THAT(report()["tuning"]["reason"].get<std::string>(), HasSubstr("--memory"));
  // A run can be continued with other tuning.
  result = succeeds(run_sequence("plain", {"--resume"}));
}

}  // namespace vantage::command_tune_test
