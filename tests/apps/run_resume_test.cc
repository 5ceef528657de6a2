// Runs that are continued with other inputs or settings.

#include "tests/apps/sampling.h"

namespace vantage::run_resume_test {

class RunResumed : public RunTest {
 protected:
  void SetUp() override { succeeds(run(out_, {"--frames", "0-9"})); }

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
  expect_one_line(refused, 1, "run", "holds a different run: the input was");
  EXPECT_THAT(refused.err, HasSubstr("left"));
  EXPECT_TRUE(same_files(results_in(out_), before));
  succeeds(run(out_, {"--resume", "--force", "--report", folder_ / "r.json"}));
  EXPECT_EQ(read_json(folder_ / "r.json")["results"]["frames"], 10);
  succeeds(run(out_, {"--resume"}));
}

TEST_F(RunResumed, FramesThatWereAddedAreAChangedInput) {
  for (const std::string side : {"left", "right"}) {
    fs::copy_file(file(side, 0), file(side, kFrames));
  }
  expect_failure(run(out_, {"--resume", "--quiet"}), 1, "21 files");
  succeeds(run(out_, {"--resume", "--force"}));
  expect_all_done(kFrames + 1);
}

TEST_F(RunResumed, WhatShotsShareIsFoundAnewWhenForced) {
  const Words outputs = {"--save", "preview", "--preview-range", "shot"};
  const std::string out = folder_ / "shots";
  const auto end_of_last_shot = [&] {
    return read_json(out + "/.vantage/shots.json")["shots"].back()["end_frame"];
  };
  succeeds(run(out, joined(outputs, {"--frames", "0-9"})));
  EXPECT_EQ(end_of_last_shot(), kFrames);
  for (const std::string side : {"left", "right"}) {
    fs::copy_file(file(side, 0), file(side, kFrames));
  }
  succeeds(run(out, joined(outputs, {"--resume", "--force"})));
  EXPECT_EQ(end_of_last_shot(), kFrames + 1);
}

using InputRunResumed = RunResumed;

TEST_F(InputRunResumed, SettingsThatDifferAreRefusedAndNamed) {
  const std::vector<Refusal> refusals = {
      {{"--window", "7"}, "window was", 1},
      {{"--format", "png"}, "format was \"pfm\", now \"png\"", 1},
      {{"--save", "disparity,preview"}, "save was", 1},
      {{"--chunk-frames", "10"}, "chunk-frames was 50, now 10", 1},
      {{"--temporal-prior", "1"}, "temporal-prior was 0.0, now 1.0", 1},
      {{"--disparities=0:8"}, "disparities was", 1}};
  expect_refusals("run", folder_.path(), refusals, [&](const Words& change) {
    Words changed = arguments(out_, {"--resume", "--quiet"});
    if (change.size() == 1) {
      std::ranges::replace(changed, std::string("--disparities=0:9"), change.front());
      return run_vantage(changed);
    }
    return run_vantage(joined(changed, change));
  });
  succeeds(
      run(out_,
          words("--resume --threads 3 --executor openmp --in-flight 7 --strip-width 9 --memory 2G "
                "--keep-going --progress none --isa SSE4")));
  EXPECT_TRUE(same_files(results_in(out_), undisturbed({})));
}

TEST_F(RunResumed, AFolderWithARunIsNotWrittenToByAccident) {
  const FolderContent before = results_in(out_);
  succeeds(run(folder_ / "whole"));
  expect_one_line(run(folder_ / "whole", {"--quiet"}), 1, "run",
                  "--resume to continue it or --overwrite to start again");
  EXPECT_EQ(run(out_, {"--quiet", "--overwrite", "--resume"}).exit_code, 2);
  EXPECT_EQ(run(out_, {"--quiet", "--overwrite", "--shard", "1/2"}).exit_code, 2);
  EXPECT_TRUE(same_files(results_in(out_), before));
  // Inputs may be moved: they are known by what is in them.
  fs::rename(left_, folder_ / "moved-left");
  fs::create_directory(folder_ / "sub");
  fs::rename(folder_ / "moved-left", folder_ / "sub/left");
  succeeds(run_vantage({"run", "--left", folder_ / "sub/left", "--right", right_, "-o", out_,
                        "--disparities=0:9", "--method", "ssd", "--resume"}));
  expect_all_done(kFrames);
}

}  // namespace vantage::run_resume_test
