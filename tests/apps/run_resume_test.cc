// Runs that are continued with other inputs or settings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/apps/run_fixture.h"

namespace vantage {
namespace run_resume_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RunResumed : public RunTest {
 protected:
  void SetUp() override { ASSERT_EQ(run(out_, {"--frames", "0-9"}).exit_code, 0); }

  [[nodiscard]] std::string file(const std::string& side, int frame) const {
    return folder_ / (side + "/" + frame_file(frame));
  }
  void expect_all_done(int frames) const {
    EXPECT_EQ(journalled_frames(out_).size(), static_cast<std::size_t>(frames));
  }

  std::string out_ = folder_ / "out";
};

TEST_F(RunResumed, InputsThatChangedAreRefusedUnlessForced) {
  const FolderContent before = results_in(out_);
  fs::copy_file(file("left", 0), file("left", 15), fs::copy_options::overwrite_existing);
  const ProcessResult refused = run(out_, {"--resume", "--quiet"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(is_one_line(refused, "run"));
  EXPECT_THAT(refused.err, HasSubstr("holds a different run: the input was"));
  EXPECT_THAT(refused.err, HasSubstr("left"));
  EXPECT_TRUE(same_files(results_in(out_), before));
  const ProcessResult forced = run(out_, {"--resume", "--force", "--report", folder_ / "r.json"});
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_EQ(read_report(folder_ / "r.json")["results"]["frames"], 10);
  EXPECT_EQ(run(out_, {"--resume"}).exit_code, 0);
}

TEST_F(RunResumed, FramesThatWereAddedAreAChangedInput) {
  for (const std::string side : {"left", "right"}) {
    fs::copy_file(file(side, 0), file(side, kFrames));
  }
  const ProcessResult refused = run(out_, {"--resume", "--quiet"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("21 files"));
  EXPECT_EQ(run(out_, {"--resume", "--force"}).exit_code, 0);
  expect_all_done(kFrames + 1);
}

TEST_F(RunResumed, WhatShotsShareIsFoundAnewWhenForced) {
  const std::vector<std::string> outputs = {"--save", "preview", "--preview-range", "shot"};
  const std::string out = folder_ / "shots";
  const auto end_of_last_shot = [&] {
    return read_report(out + "/.vantage/shots.json")["shots"].back()["end_frame"];
  };
  ASSERT_EQ(run(out, joined(outputs, {"--frames", "0-9"})).exit_code, 0);
  EXPECT_EQ(end_of_last_shot(), kFrames);
  for (const std::string side : {"left", "right"}) {
    fs::copy_file(file(side, 0), file(side, kFrames));
  }
  ASSERT_EQ(run(out, joined(outputs, {"--resume", "--force"})).exit_code, 0);
  EXPECT_EQ(end_of_last_shot(), kFrames + 1);
}

using InputRunResumed = RunResumed;

TEST_F(InputRunResumed, SettingsThatDifferAreRefusedAndNamed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> changes = {
      {{"--window", "7"}, "window was"},
      {{"--format", "png"}, "format was \"pfm\", now \"png\""},
      {{"--save", "disparity,preview"}, "save was"},
      {{"--chunk-frames", "10"}, "chunk-frames was 50, now 10"},
      {{"--temporal-prior", "1"}, "temporal-prior was 0.0, now 1.0"},
      {{"--disparities=0:8"}, "disparities was"}};
  for (const auto& [change, says] : changes) {
    std::vector<std::string> changed = arguments(out_, {"--resume", "--quiet"});
    if (change.size() == 1) {
      std::ranges::replace(changed, std::string("--disparities=0:9"), change.front());
    } else {
      changed = joined(changed, change);
    }
    const ProcessResult refused = run_vantage(changed);
    EXPECT_EQ(refused.exit_code, 1) << says;
    EXPECT_TRUE(is_one_line(refused, "run"));
    EXPECT_THAT(refused.err, HasSubstr(says));
  }
  EXPECT_EQ(run(out_, {"--resume", "--threads", "3", "--executor", "openmp", "--in-flight", "7",
                       "--strip-width", "9", "--memory", "2G", "--keep-going", "--progress", "none",
                       "--isa", "SSE4"})
                .exit_code,
            0);
  EXPECT_TRUE(same_files(results_in(out_), undisturbed({})));
}

TEST_F(RunResumed, AFolderWithARunIsNotWrittenToByAccident) {
  const FolderContent before = results_in(out_);
  ASSERT_EQ(run(folder_ / "whole").exit_code, 0);
  const ProcessResult refused = run(folder_ / "whole", {"--quiet"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(is_one_line(refused, "run"));
  EXPECT_THAT(refused.err, HasSubstr("--resume to continue it or --overwrite to start again"));
  EXPECT_EQ(run(out_, {"--quiet", "--overwrite", "--resume"}).exit_code, 2);
  EXPECT_EQ(run(out_, {"--quiet", "--overwrite", "--shard", "1/2"}).exit_code, 2);
  EXPECT_TRUE(same_files(results_in(out_), before));
  // Inputs may be moved: they are known by what is in them.
  fs::rename(left_, folder_ / "moved-left");
  fs::create_directory(folder_ / "sub");
  fs::rename(folder_ / "moved-left", folder_ / "sub/left");
  EXPECT_EQ(run_vantage({"run", "--left", folder_ / "sub/left", "--right", right_, "-o", out_,
                         "--disparities=0:9", "--method", "ssd", "--resume"})
                .exit_code,
            0);
  expect_all_done(kFrames);
}

}  // namespace run_resume_test
}  // namespace vantage
