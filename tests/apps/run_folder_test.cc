// Several processes in one folder, and folders that are not as a run left them.

#include <chrono>
#include <csignal>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/apps/sampling.h"

namespace vantage::run_folder_test {

class RunFolder : public RunTest {
 protected:
  [[nodiscard]] ProcessResult merge() const { return run_vantage({"merge", out_, "--quiet"}); }
  [[nodiscard]] std::string journal() const { return out_ + "/.vantage/frames-all.jsonl"; }
  [[nodiscard]] std::string description() const { return out_ + "/.vantage/run.json"; }

  /// A process that has begun and then been stopped, so that it holds what it works on.
  [[nodiscard]] std::unique_ptr<VantageProcess> stopped_process(const Words& more) const {
    auto process = std::make_unique<VantageProcess>(arguments(out_, more), streams_.path());
    while (!fs::exists(out_ + "/disparity") && !process->has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    process->send(SIGSTOP);
    return process;
  }

  void expect_resumed(const FolderContent& expected, const Words& outputs) const {
    succeeds(run(out_, joined(outputs, {"--resume"})));
    EXPECT_TRUE(same_files(results_in(out_), expected));
  }

  std::string out_ = folder_ / "out";
  TemporaryFolder streams_;
};

TEST_F(RunFolder, OneProcessPerPart) {
  // Slow enough to be still at work when it is stopped.
  const Words slow = {"--method", "membrane", "--iterations", "300"};
  const FolderContent expected = undisturbed(slow);
  const auto process = stopped_process(slow);
  ASSERT_FALSE(process->has_ended());
  for (const std::string opening : {"--resume", "--force", "--overwrite"}) {
    expect_one_line(run(out_, joined(slow, {opening, "--quiet"})), 1, "run",
                    out_ + ": another process is working on this");
  }
  process->send(SIGCONT);
  succeeds(process->wait());
  EXPECT_TRUE(same_files(results_in(out_), expected));
  EXPECT_EQ(journalled_frames(out_).size(), static_cast<std::size_t>(kFrames));
}

TEST_F(RunFolder, TheAdviceOfMergeComputesWhatIsMissing) {
  succeeds(run(out_, {"--frames", "2-5", "--chunk-frames", "2", "--shard", "1/2"}));
  succeeds(run_vantage({"merge", out_, "--partial"}));
  // That part alone, as it was asked for.
  succeeds(run_vantage({"run", "-o", out_, "--resume"}));
  EXPECT_EQ(journalled_frames(out_), (std::vector<int>{2, 3}));
  // The frames that all parts have in common.
  succeeds(run(out_, {"--frames", "2-5", "--chunk-frames", "2", "--shard", "2/2"}));
  fs::remove(out_ + "/disparity/000004.pfm");
  succeeds(run_vantage({"run", "-o", out_, "--resume"}));
  EXPECT_TRUE(fs::exists(out_ + "/disparity/000004.pfm"));
  EXPECT_EQ(journalled_frames(out_), (std::vector<int>{2, 3, 4, 5}));
  EXPECT_THAT(merge().err, HasSubstr("--resume --frames all' computes them"));
  succeeds(run_vantage({"run", "-o", out_, "--resume", "--frames", "all"}));
  succeeds(merge());
}

TEST_F(RunFolder, DeletedResultsOfPartsAreMadeAgain) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  const Words part = joined(kVideoOutputs, {"--shard", "1/2"});
  succeeds(run(out_, part));
  succeeds(run(out_, joined(kVideoOutputs, {"--shard", "2/2"})));
  succeeds(merge());
  fs::remove(out_ + "/disparity/000003.pfm");
  succeeds(run(out_, joined(part, {"--resume"})));
  succeeds(merge());
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

using InputRunFolder = RunFolder;

TEST_F(InputRunFolder, ALineThatWasTornOff) {
  for (const auto& outputs : {kImageOutputs, kVideoOutputs}) {
    const FolderContent expected = undisturbed(outputs);
    succeeds(run(out_, joined(outputs, {"--frames", "0-9"})));
    // Part of the run "all" from now on.
    fs::rename(out_ + "/.vantage/frames-frames-0-9.jsonl", journal());
    const std::string whole = read_file(journal());
    for (const std::size_t cut : sampled<std::size_t>({1, 15, whole.size() / 2}, 0, 6)) {
      write_file(journal(), whole.substr(0, whole.size() - cut));
      fs::remove(out_ + "/disparity/000009.pfm");
      expect_resumed(expected, outputs);
      std::istringstream lines(read_file(journal()));
      for (std::string line; std::getline(lines, line);) {
        EXPECT_TRUE(nlohmann::json::accept(line)) << line;
      }
    }
    fs::remove_all(out_);
  }
}

TEST_F(InputRunFolder, LinesThatAreDamagedCountForNothing) {
  const FolderContent expected = undisturbed({});
  succeeds(run(out_));
  const Words lines = {
      "",
      "{",
      "null",
      "[]",
      "[1, 2]",
      "\"frame\"",
      "5",
      std::string(3, '\0'),
      "\xff\xfe{}",
      "{}",
      R"({"frame":"3"})",
      R"({"frame":3,"files":"disparity/000003.pfm"})",
      R"({"frame":3,"files":[3]})",
      R"({"frame":3,"files":["disparity/000099.pfm"]})",
      R"({"frame":3,"skipped":1})",
      R"({"frame":3.5e99})",
      R"({"frame":3,"comfort":{}})",
      R"({"segment":[0]})",
      R"({"segment":"0-19"})",
      R"({"segment":[0,20]})",
      R"({"joined":null})",
      R"({"joined":[0,20]})",
      std::string(100000, '['),
      R"({"frame":-1,"files":["disparity/000003.pfm"]})",
      R"({"frame":2000000000,"files":["disparity/000003.pfm"]})",
  };
  std::string kept;
  std::istringstream journal_lines(read_file(journal()));
  for (std::string line; std::getline(journal_lines, line);) {
    if (line.find("\"frame\":3,") == std::string::npos) {
      kept += line + "\n";
    }
  }
  for (const std::string& line : lines) {
    kept += line + "\n";
  }
  write_file(journal(), kept);
  fs::remove(out_ + "/disparity/000003.pfm");
  expect_one_line(merge(), 1, "merge", "1 of 20 frames are missing (3)");
  expect_resumed(expected, {});
  succeeds(merge());
  const std::string report = folder_ / "report.json";
  succeeds(run_vantage({"merge", out_, "--partial", "--report", report}));
  EXPECT_EQ(read_json(report)["results"]["first_frame"], 0);
  EXPECT_EQ(read_json(report)["results"]["frames"], kFrames);
}

/// Numbers that no frame has must not keep the videos of all others from being joined.
TEST_F(InputRunFolder, FramesThatCannotBeDoNotCount) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  succeeds(run(out_, joined(kVideoOutputs, {"--shard", "1/1"})));
  fs::rename(out_ + "/.vantage/frames-1-of-1.jsonl", journal());
  write_file(journal(), read_file(journal()) + R"({"frame":-1}
{"frame":2000000000}
{"frame":99999999999999}
{"joined":[-5,3000]}
{"segment":[-5,3000]}
)");
  expect_resumed(expected, kVideoOutputs);
}

TEST_F(InputRunFolder, ADescriptionThatIsDamagedIsAClearError) {
  succeeds(run(out_));
  const FolderContent expected = results_in(out_);
  const std::string whole = read_file(description());
  const auto with = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json json = nlohmann::json::parse(whole);
    json[key] = value;
    return json.dump();
  };
  nlohmann::json without_inputs = nlohmann::json::parse(whole);
  without_inputs.erase("inputs");
  const Words texts = {"",
                       "{}",
                       "[]",
                       "null",
                       "\xff",
                       whole.substr(0, whole.size() / 2),
                       without_inputs.dump(),
                       with("format", "one"),
                       with("settings", 5),
                       with("settings", "{}"),
                       with("settings", nlohmann::json::array()),
                       with("inputs", 3),
                       with("inputs", {{"a", 1}}),
                       with("frame_count", "many"),
                       with("frame_count", -1),
                       with("sound", nullptr)};
  bool merges = false;
  SCOPED_TRACE(test::sample_name());
  for (const std::string& text : sampled(texts, test_paths::is_sanitized() ? 2 : 6, 8)) {
    write_file(description(), text);
    merges = !merges;
    const ProcessResult result = merges ? merge() : run(out_, {"--resume", "--quiet"});
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_TRUE(is_one_line(result, merges ? "merge" : "run"));
    EXPECT_THAT(result.err, HasSubstr(description() + ":")) << text;
    EXPECT_THAT(result.err, ContainsRegex("is damaged|is not JSON")) << text;
  }
  write_file(description(), with("format", 7));
  for (const ProcessResult& result : {run(out_, {"--resume", "--quiet"}), merge()}) {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err,
                ContainsRegex("has format 7 .*, expected 3; finish the run with that version"));
  }
  EXPECT_TRUE(same_files(results_in(out_), expected));
  succeeds(run(out_, {"--overwrite"}));
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

TEST_F(InputRunFolder, ATableOfShotsThatIsDamagedIsAClearError) {
  const Words outputs = {"--save", "preview", "--preview-range", "shot"};
  const FolderContent expected = undisturbed(outputs);
  succeeds(run(out_, joined(outputs, {"--frames", "0-9"})));
  const std::string shots = out_ + "/.vantage/shots.json";
  const std::string whole = read_file(shots);
  ASSERT_FALSE(whole.empty());
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[]"), whole.substr(0, whole.size() / 2)}) {
    write_file(shots, text);
    expect_one_line(run(out_, joined(outputs, {"--resume", "--quiet"})), 1, "run", shots);
  }
  // Where it is missing it is made again.
  fs::remove(shots);
  expect_resumed(expected, outputs);
}

TEST_F(RunFolder, WhereThereIsNoRun) {
  expect_one_line(run_vantage({"merge", folder_ / "nowhere"}), 1, "merge");
  expect_failure(run_vantage({"merge", left_}), 1, "holds no run");
  // Nothing to resume: it begins.
  succeeds(run(out_, {"--resume"}));
  succeeds(run(out_, {"--overwrite"}));
}

TEST_F(RunFolder, FilesThatNoRunMadeAreNotReplacedUnasked) {
  fs::create_directories(out_ + "/disparity");
  write_file(out_ + "/disparity/000003.pfm", "mine");
  for (const Words& options :
       {Words{"--quiet"}, Words{"--quiet", "--resume"}, Words{"--quiet", "--force"}}) {
    expect_one_line(run(out_, options), 1, "run",
                    "disparity/000003.pfm is there, expected a folder without such files");
    EXPECT_EQ(read_file(out_ + "/disparity/000003.pfm"), "mine");
  }
  succeeds(run(out_, {"--overwrite"}));
  EXPECT_NE(read_file(out_ + "/disparity/000003.pfm"), "mine");
}

TEST_F(RunFolder, FilesOfOthersStay) {
  fs::create_directories(out_ + "/disparity");
  write_file(out_ + "/disparity/notes.txt", "mine");
  write_file(out_ + "/disparity/.hidden", "mine");
  write_file(out_ + "/disparity/.000003.swp", "mine");
  write_file(out_ + "/.bashrc", "mine");
  succeeds(run(out_, {"--frames", "0-9"}));
  succeeds(run(out_, {"--resume"}));
  succeeds(run(out_, {"--overwrite"}));
  for (const std::string name :
       {"/disparity/notes.txt", "/disparity/.hidden", "/disparity/.000003.swp", "/.bashrc"}) {
    EXPECT_EQ(read_file(out_ + name), "mine") << name;
  }
}

}  // namespace vantage::run_folder_test
