// vantage batch: the results of each item are those of match or run, whatever jobs it came in.

#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include "tests/apps/batch_fixture.h"

namespace vantage::command_batch_test {

class Batch : public BatchTest {};

TEST_F(Batch, ResultsAreThoseOfEachPairAlone) {
  constexpr int kPairs = 5;
  write_manifest(lines_of_pairs(kPairs));
  const Words options =
      words("--preset realtime --save disparity,preview --format png --no-tuning");
  succeeds(batch(options));
  const FolderContent together = results();
  EXPECT_EQ(together.size(), 2U * kPairs);
  EXPECT_EQ(item_lines().size(), static_cast<std::size_t>(kPairs));
  for (int frame = 0; frame < kPairs; ++frame) {
    const std::string map = folder_ / "alone.png";
    const std::string colours = folder_ / "colours.png";
    succeeds(run_vantage({"match", left_ + "/" + frame_file(frame),
                          right_ + "/" + frame_file(frame), "-o", map, "--preview", colours,
                          "--disparities", frame % 2 == 0 ? "0:9" : "auto", "--preset", "realtime",
                          "--no-tuning", "--quiet"}));
    const std::string name = "pair-" + std::to_string(frame);
    EXPECT_TRUE(together.at(name + "/disparity.png") == read_file(map)) << name;
    EXPECT_TRUE(together.at(name + "/preview.png") == read_file(colours)) << name;
  }

  // One by one.
  fs::remove_all(out_);
  const ProcessResult planned = batch(joined(options, words("--job-time 1ms")));
  expect_one_line(planned, 2, "batch", "--job-time is '1ms', expected 1 s to 604800 s");
  write_manifest(lines_of_pairs(kPairs) + "film,,,\n");
  expect_one_line(batch(), 2, "batch", "line 7: no input is given");
}

TEST_F(Batch, FilmsAreRunsInTheirFolders) {
  write_manifest(
      "output,left,right,frames,save\n"
      "a/film,left,right,0-9,\n"
      "b,left,right,,\"disparity,preview\"\n");
  const Words options = words("--preset realtime --disparities=0:9 --chunk-frames 5 --no-tuning");
  succeeds(batch(options));
  EXPECT_EQ(item_lines()[0]["frames"], 10);
  EXPECT_EQ(item_lines()[1]["frames"], kFrames);
  const std::string alone = folder_ / "alone";
  succeeds(run_vantage(joined({"run", "--left", left_, "--right", right_, "--save",
                               "disparity,preview", "-o", alone, "--quiet"},
                              options)));
  EXPECT_TRUE(same_files(results_in(out_ + "/b"), results_in(alone)));
  succeeds(run_vantage({"verify", out_ + "/a/film"}));
  EXPECT_EQ(journalled_frames(out_ + "/a/film").size(), 10U);
}

TEST_F(Batch, BadItemsFailAloneAndCanBeTriedAgain) {
  write_manifest(lines_of_pairs(3) +
                 "missing,left/none.png,right/none.png,0:9\n"
                 "film,left,elsewhere,\n");
  write_file(left_ + "/000001.png", "no image");
  const Words options = words("--preset realtime --attempts 1 --no-tuning");
  const ProcessResult result = batch(options);
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("line 3 (pair-1) failed: "));
  EXPECT_THAT(result.err, HasSubstr("line 6 (film) failed: "));
  const auto lines = item_lines();
  ASSERT_EQ(lines.size(), 5U);
  const Words status = {lines[0]["status"], lines[1]["status"], lines[2]["status"],
                        lines[3]["status"], lines[4]["status"]};
  EXPECT_THAT(status, ElementsAre("done", "failed", "done", "failed", "failed"));

  // The command that is told repeats one.
  const std::string command = lines[1]["command"];
  ASSERT_THAT(command, StartsWith("vantage run "));
  expect_failure(run_vantage(words(command.substr(8))), 1, "000001.png");

  fs::copy_file(left_ + "/000000.png", left_ + "/000001.png", fs::copy_options::overwrite_existing);
  fs::create_directory(folder_ / "elsewhere");
  fs::copy(right_, folder_ / "elsewhere", fs::copy_options::recursive);
  const FolderContent before = results();
  expect_one_line(batch(options), 1, "batch", "holds a batch already, expected --resume");
  EXPECT_EQ(batch(joined(options, {"--retry-failed"})).exit_code, 3);
  EXPECT_EQ(item_lines()[1]["status"], "done");
  EXPECT_EQ(item_lines()[4]["status"], "done");
  for (const auto& [name, bytes] : before) {
    EXPECT_TRUE(results().at(name) == bytes) << name;
  }
}

TEST_F(Batch, RefusesWhatItCannotDoBeforeAnythingIsComputed) {
  const std::vector<std::pair<std::string, std::string>> manifests = {
      {"", "the file is empty"},
      {"left,right\na,b\n", "line 1: the columns are left, right, expected a heading with output"},
      {"output,left,rigth\nx,a,b\n", "unknown option 'rigth', did you mean right?"},
      {"output,left,right,threads\nx,a,b,2\n", "'threads' is no option of an item"},
      {"output,left,right\nx,a\n", "line 2: 2 fields, expected 3"},
      {"output,left,right\n../x,a,b\n", "the output is '../x', expected a folder below"},
      {"output,left,right\n.x,a,b\n", "the output is '.x', expected a folder below"},
      {"output,left,right\nx,a,b\nx,c,d\n", "line 3: the output 'x' is that of line 2, too"},
      {"output,left,right\nx/y,a,b\nx,c,d\n", "line 2: the output 'x/y' is inside that of line 3"},
      {"output,left,right\n", "holds no items"},
      {"output,left,right,preset\nx,a,b,best\n", "preset is 'best', expected one of"},
      {"output,stereo\nx,-\n", "the input is a stream, expected files"},
      {"{\"output\": 3}\n", "line 1: expected an object with a text output"},
      {"{\"output\": \"x\", \"left\": \"a\"\n", "line 1:1"},
  };
  for (const auto& [text, says] : manifests) {
    write_manifest(text);
    const ProcessResult result = batch();
    EXPECT_THAT(result.exit_code, AnyOf(1, 2)) << text;
    EXPECT_TRUE(is_one_line(result, "batch")) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
    EXPECT_FALSE(fs::exists(out_ + "/.vantage/batch/plan.json"));
  }
  write_manifest(lines_of_pairs(1));
  const std::vector<std::pair<Words, std::string>> options = {
      {words("--left x"), "--left is a column of the manifest"},
      {words("--shard 1/2"), "--shard has no sense for a batch"},
      {words("--worker --index 1/2"), "expected one of them"},
      {words("--worker --resume"), "--resume has no effect with --worker"},
      {words("--index 3/2"), "--index is '3/2', expected K/N"},
      {words("--index auto"), "--index is 'auto', expected K/N"},
      {words("--attempts 0"), "--attempts is 0"},
  };
  for (const auto& [more, says] : options) {
    expect_one_line(batch(more), 2, "batch", says);
  }
  expect_one_line(batch(words("--index auto"), {"JOB_COMPLETION_INDEX=1"}), 2, "batch",
                  "but not of how many; expected VANTAGE_BATCH_TASKS=N");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Batch, FilesThatItDidNotMakeStay) {
  write_manifest(lines_of_pairs(2));
  fs::create_directories(out_ + "/pair-1");
  write_file(out_ + "/pair-1/disparity.pfm", "mine");
  EXPECT_EQ(batch(words("--preset realtime")).exit_code, 3);
  EXPECT_EQ(read_file(out_ + "/pair-1/disparity.pfm"), "mine");
  EXPECT_THAT(item_lines()[1]["problem"].get<std::string>(), HasSubstr("did not make it"));
  EXPECT_EQ(item_lines()[0]["status"], "done");
}

TEST_F(Batch, TasksOfAnArrayShareTheJobs) {
  write_manifest("output,left,right\nfilm,left,right\nother,left,right\n");
  const Words options = words("--preset realtime --disparities=0:9 --chunk-frames 1 --no-tuning");
  const Words plan = joined(options, words("--job-time 1s --dry-run"));
  EXPECT_THAT(succeeds(batch(plan)).out, HasSubstr("2 items, 40 frames: "));
  EXPECT_FALSE(fs::exists(out_));
  for (const auto& variables :
       {words("SLURM_ARRAY_TASK_ID=8 SLURM_ARRAY_TASK_MIN=7 SLURM_ARRAY_TASK_COUNT=2"),
        words("JOB_COMPLETION_INDEX=0 VANTAGE_BATCH_TASKS=2")}) {
    succeeds(batch(joined(options, words("--index auto")), variables));
  }
  EXPECT_EQ(item_lines().size(), 2U);
  EXPECT_TRUE(same_files(results_in(out_ + "/film"), results_in(out_ + "/other")));
  expect_one_line(batch(words("--worker --preset quality")), 1, "batch",
                  "holds a batch with other options");
  write_manifest("output,left,right\nfilm,left,right\n");
  expect_one_line(batch(words("--worker")), 1, "batch", "holds a batch of another manifest");
}

/// Several workers, some of which are killed.
class SlowBatch : public BatchTest {};

TEST_F(SlowBatch, KilledWorkersLoseNothing) {
  std::string text = lines_of_pairs(8);
  write_manifest(text + "film,left,right,0:9\nother,left,right,0:9\n");
  const Words options = words(
      "--preset realtime --save disparity,preview --video preview --chunk-frames 2 "
      "--no-tuning --job-time 1s --lease 2s --quiet");
  // A column video would make pairs of one frame films; so pairs are runs here, too.
  succeeds(batch(options));
  const FolderContent expected = results();
  fs::remove_all(out_);
  std::vector<std::unique_ptr<VantageProcess>> workers;
  const auto start = [&] {
    workers.push_back(std::make_unique<VantageProcess>(batch_words(joined(options, {"--worker"})),
                                                       folder_.path()));
  };
  for (int kill = 0; kill < 4; ++kill) {
    start();
    start();
    std::this_thread::sleep_for(std::chrono::milliseconds(150 + 170 * kill));
    for (auto& worker : workers) {
      worker->send(SIGKILL);
      (void)worker->wait();
    }
    workers.clear();
  }
  start();
  start();
  for (auto& worker : workers) {
    succeeds(worker->wait());
  }
  EXPECT_TRUE(same_files(results(), expected));
  EXPECT_EQ(item_lines().size(), 10U);
  for (const auto& line : item_lines()) {
    EXPECT_EQ(line["status"], "done") << line;
  }
}

TEST_F(SlowBatch, HandsBackWhenItIsAskedToEnd) {
  write_manifest("output,left,right\nfilm,left,right\n");
  const Words options = words("--preset quality --disparities=0:30 --lease 600s --worker");
  VantageProcess worker(batch_words(options), folder_.path());
  while (!fs::exists(out_ + "/film/.vantage/run.json")) {
    ASSERT_FALSE(worker.has_ended());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  worker.send(SIGTERM);
  const ProcessResult ended = worker.wait();
  EXPECT_EQ(ended.exit_code, 75) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("handed back"));
  // At once, although the lease is long.
  succeeds(batch(options));
  EXPECT_EQ(journalled_frames(out_ + "/film").size(), static_cast<std::size_t>(kFrames));
}

}  // namespace vantage::command_batch_test
