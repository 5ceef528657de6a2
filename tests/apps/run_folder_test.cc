// Several processes in one folder, and folders that are not as a run left them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/apps/run_fixture.h"
#include "tests/apps/sampling.h"
#include "tests/test_paths.h"

namespace vantage {
namespace run_folder_test {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;

class RunFolder : public RunTest {
 protected:
  [[nodiscard]] ProcessResult merge() const { return run_vantage({"merge", out_, "--quiet"}); }
  [[nodiscard]] std::string journal() const { return out_ + "/.vantage/frames-all.jsonl"; }
  [[nodiscard]] std::string description() const { return out_ + "/.vantage/run.json"; }

  /// A process that has begun and then been stopped, so that it holds what it works on.
  [[nodiscard]] std::unique_ptr<VantageProcess> stopped_process(
      const std::vector<std::string>& more) const {
    auto process = std::make_unique<VantageProcess>(arguments(out_, more), streams_.path());
    while (!fs::exists(out_ + "/disparity") && !process->has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    process->send(SIGSTOP);
    return process;
  }

  void expect_resumed(const FolderContent& expected,
                      const std::vector<std::string>& outputs) const {
    const ProcessResult result = run(out_, joined(outputs, {"--resume"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(same_files(results_in(out_), expected));
  }

  std::string out_ = folder_ / "out";
  TemporaryFolder streams_;
};

TEST_F(RunFolder, OneProcessPerPart) {
  // Slow enough to be still at work when it is stopped.
  const std::vector<std::string> slow = {"--method", "membrane", "--iterations", "300"};
  const FolderContent expected = undisturbed(slow);
  const auto process = stopped_process(slow);
  ASSERT_FALSE(process->has_ended());
  for (const std::string opening : {"--resume", "--force", "--overwrite"}) {
    const ProcessResult second = run(out_, joined(slow, {opening, "--quiet"}));
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_TRUE(is_one_line(second, "run"));
    EXPECT_THAT(second.err, HasSubstr(out_ + ": another process is working on this"));
  }
  process->send(SIGCONT);
  EXPECT_EQ(process->wait().exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out_), expected));
  EXPECT_EQ(journalled_frames(out_).size(), static_cast<std::size_t>(kFrames));
}

TEST_F(RunFolder, PartsAtOneTime) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  std::vector<std::unique_ptr<TemporaryFolder>> streams;
  std::vector<std::unique_ptr<VantageProcess>> processes;
  for (const std::string shard : {"1/3", "2/3", "3/3"}) {
    streams.push_back(std::make_unique<TemporaryFolder>());
    processes.push_back(std::make_unique<VantageProcess>(
        arguments(out_, joined(kVideoOutputs, {"--shard", shard})), streams.back()->path()));
  }
  for (const auto& process : processes) {
    const ProcessResult result = process->wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_EQ(merge().exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out_), expected));
  EXPECT_THAT(leftovers_in(out_), IsEmpty());
  // Once more changes nothing.
  EXPECT_EQ(merge().exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

TEST_F(RunFolder, PartsThatAreMissingAreNamed) {
  ASSERT_EQ(run(out_, {"--chunk-frames", "5", "--shard", "2/4"}).exit_code, 0);
  ProcessResult merged = merge();
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_TRUE(is_one_line(merged, "merge"));
  EXPECT_THAT(merged.err, HasSubstr("15 of 20 frames are missing (0-4, 10-19)"));
  EXPECT_THAT(merged.err, HasSubstr("--resume --frames all' computes them, --partial leaves them"));
  ASSERT_EQ(run(out_, {"--chunk-frames", "5", "--shard", "1/4"}).exit_code, 0);
  ASSERT_EQ(run(out_, {"--chunk-frames", "5", "--resume"}).exit_code, 0);
  EXPECT_EQ(merge().exit_code, 0);
  fs::remove(out_ + "/disparity/000012.pfm");
  merged = merge();
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_THAT(merged.err, HasSubstr("1 of 20 frames are missing (12)"));
}

TEST_F(RunFolder, TheAdviceOfMergeComputesWhatIsMissing) {
  ASSERT_EQ(run(out_, {"--frames", "2-5", "--chunk-frames", "2", "--shard", "1/2"}).exit_code, 0);
  EXPECT_EQ(run_vantage({"merge", out_, "--partial"}).exit_code, 0);
  // That part alone, as it was asked for.
  ASSERT_EQ(run_vantage({"run", "-o", out_, "--resume"}).exit_code, 0);
  EXPECT_EQ(journalled_frames(out_), (std::vector<int>{2, 3}));
  // The frames that all parts have in common.
  ASSERT_EQ(run(out_, {"--frames", "2-5", "--chunk-frames", "2", "--shard", "2/2"}).exit_code, 0);
  fs::remove(out_ + "/disparity/000004.pfm");
  ASSERT_EQ(run_vantage({"run", "-o", out_, "--resume"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(out_ + "/disparity/000004.pfm"));
  EXPECT_EQ(journalled_frames(out_), (std::vector<int>{2, 3, 4, 5}));
  EXPECT_THAT(merge().err, HasSubstr("--resume --frames all' computes them"));
  ASSERT_EQ(run_vantage({"run", "-o", out_, "--resume", "--frames", "all"}).exit_code, 0);
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(RunFolder, DeletedResultsAreMadeAgain) {
  for (const auto& outputs : {kImageOutputs, kVideoOutputs}) {
    const FolderContent expected = undisturbed(outputs);
    ASSERT_EQ(run(out_, outputs).exit_code, 0);
    fs::remove(out_ + "/disparity/000003.pfm");
    write_file(out_ + "/disparity/000011.pfm", "");
    expect_resumed(expected, outputs);
    EXPECT_FALSE(fs::exists(out_ + "/.vantage/segments"));
    fs::remove_all(out_ + "/disparity");
    fs::remove_all(out_ + "/views");
    fs::remove(out_ + "/views.mp4");
    expect_resumed(expected, outputs);
    fs::remove_all(out_);
  }
}

TEST_F(RunFolder, DeletedResultsOfPartsAreMadeAgain) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  const std::vector<std::string> part = joined(kVideoOutputs, {"--shard", "1/2"});
  ASSERT_EQ(run(out_, part).exit_code, 0);
  ASSERT_EQ(run(out_, joined(kVideoOutputs, {"--shard", "2/2"})).exit_code, 0);
  ASSERT_EQ(merge().exit_code, 0);
  fs::remove(out_ + "/disparity/000003.pfm");
  ASSERT_EQ(run(out_, joined(part, {"--resume"})).exit_code, 0);
  ASSERT_EQ(merge().exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

using InputRunFolder = RunFolder;

TEST_F(InputRunFolder, ALineThatWasTornOff) {
  for (const auto& outputs : {kImageOutputs, kVideoOutputs}) {
    const FolderContent expected = undisturbed(outputs);
    ASSERT_EQ(run(out_, joined(outputs, {"--frames", "0-9"})).exit_code, 0);
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
  ASSERT_EQ(run(out_).exit_code, 0);
  const std::vector<std::string> lines = {
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
      R"({"frame":3,"flicker":{}})",
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
  const ProcessResult merged = merge();
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_TRUE(is_one_line(merged, "merge"));
  EXPECT_THAT(merged.err, HasSubstr("1 of 20 frames are missing (3)"));
  expect_resumed(expected, {});
  EXPECT_EQ(merge().exit_code, 0);
  const std::string report = folder_ / "report.json";
  EXPECT_EQ(run_vantage({"merge", out_, "--partial", "--report", report}).exit_code, 0);
  EXPECT_EQ(read_report(report)["results"]["first_frame"], 0);
  EXPECT_EQ(read_report(report)["results"]["frames"], kFrames);
}

/// Numbers that no frame has must not keep the videos of all others from being joined.
TEST_F(InputRunFolder, FramesThatCannotBeDoNotCount) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  ASSERT_EQ(run(out_, joined(kVideoOutputs, {"--shard", "1/1"})).exit_code, 0);
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
  ASSERT_EQ(run(out_).exit_code, 0);
  const FolderContent expected = results_in(out_);
  const std::string whole = read_file(description());
  const auto with = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json json = nlohmann::json::parse(whole);
    json[key] = value;
    return json.dump();
  };
  nlohmann::json without_inputs = nlohmann::json::parse(whole);
  without_inputs.erase("inputs");
  const std::vector<std::string> texts = {"",
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
    EXPECT_THAT(result.err, testing::HasSubstr(description() + ":")) << text;
    EXPECT_THAT(result.err, testing::ContainsRegex("is damaged|is not JSON")) << text;
  }
  write_file(description(), with("format", 7));
  for (const ProcessResult& result : {run(out_, {"--resume", "--quiet"}), merge()}) {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err,
                ContainsRegex("has format 7 .*, expected 2; finish the run with that version"));
  }
  EXPECT_TRUE(same_files(results_in(out_), expected));
  EXPECT_EQ(run(out_, {"--overwrite"}).exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

TEST_F(InputRunFolder, ATableOfShotsThatIsDamagedIsAClearError) {
  const std::vector<std::string> outputs = {"--save", "preview", "--preview-range", "shot"};
  const FolderContent expected = undisturbed(outputs);
  ASSERT_EQ(run(out_, joined(outputs, {"--frames", "0-9"})).exit_code, 0);
  const std::string shots = out_ + "/.vantage/shots.json";
  const std::string whole = read_file(shots);
  ASSERT_FALSE(whole.empty());
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[]"), whole.substr(0, whole.size() / 2)}) {
    write_file(shots, text);
    const ProcessResult result = run(out_, joined(outputs, {"--resume", "--quiet"}));
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_TRUE(is_one_line(result, "run"));
    EXPECT_THAT(result.err, HasSubstr(shots)) << text;
  }
  // Where it is missing it is made again.
  fs::remove(shots);
  expect_resumed(expected, outputs);
}

TEST_F(RunFolder, WhereThereIsNoRun) {
  const ProcessResult none = run_vantage({"merge", folder_ / "nowhere"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_TRUE(is_one_line(none, "merge"));
  const ProcessResult empty = run_vantage({"merge", left_});
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.err, HasSubstr("holds no run"));
  // Nothing to resume: it begins.
  EXPECT_EQ(run(out_, {"--resume"}).exit_code, 0);
  EXPECT_EQ(run(out_, {"--overwrite"}).exit_code, 0);
}

TEST_F(RunFolder, FilesOfOthersStay) {
  fs::create_directories(out_ + "/disparity");
  write_file(out_ + "/disparity/notes.txt", "mine");
  write_file(out_ + "/disparity/.hidden", "mine");
  write_file(out_ + "/disparity/.000003.swp", "mine");
  write_file(out_ + "/.bashrc", "mine");
  EXPECT_EQ(run(out_, {"--frames", "0-9"}).exit_code, 0);
  EXPECT_EQ(run(out_, {"--resume"}).exit_code, 0);
  EXPECT_EQ(run(out_, {"--overwrite"}).exit_code, 0);
  for (const std::string name :
       {"/disparity/notes.txt", "/disparity/.hidden", "/disparity/.000003.swp", "/.bashrc"}) {
    EXPECT_EQ(read_file(out_ + name), "mine") << name;
  }
}

}  // namespace run_folder_test
}  // namespace vantage
