// Runs that are killed or stopped while they look for the shots of their input.

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

namespace vantage::run_survey_test {

constexpr int kKilled = 128 + SIGKILL;

const Words kShotOutputs =
    words("--save preview,views --view 0.5 --intensity-fit shot --preview-range shot");

class Survey : public RunTest {
 protected:
  std::string out_ = folder_ / "out";
  std::string shots_ = out_ + "/.vantage/shots.json";
};

using SlowSurvey = Survey;

/// The process is killed before calls that lie between its start and its first results: the
/// journal's, and those that make the table of shots.
TEST_F(SlowSurvey, MayBeKilledAtAnyCall) {
  SCOPED_TRACE(test::sample_name());
  const Words all = arguments(out_, kShotOutputs);
  const FileCalls calls = calls_of(all, out_);
  const FolderContent expected = results_in(out_);
  const std::string table = read_file(shots_);
  // Files that must not replace others get their names by links: the description, then the table.
  const std::vector<int> links = calls.numbers_of("link");
  ASSERT_EQ(links.size(), 2U);
  ASSERT_GT(links[1], 8);
  for (const int call : sampled_range(1, links[1] + 2, 2, 1, {links[0], links[1], links[1] + 1})) {
    SCOPED_TRACE("killed before call " + std::to_string(call));
    fs::remove_all(out_);
    const ProcessResult killed = run_vantage(all, fault_at("KILL", call, out_));
    ASSERT_EQ(killed.exit_code, kKilled) << killed.err;
    EXPECT_THAT(journalled_frames(out_), IsEmpty());
    ASSERT_EQ(fs::exists(shots_), call > links[1]);
    if (call > links[1]) {
      EXPECT_EQ(read_file(shots_), table);
    }
    succeeds(run(out_, joined(kShotOutputs, {"--resume"})));
    EXPECT_TRUE(same_files(results_in(out_), expected));
    EXPECT_EQ(read_file(shots_), table);
    EXPECT_THAT(leftovers_in(out_), IsEmpty());
  }
}

/// What one part has found is what all others go by, whatever they would have found themselves.
TEST_F(Survey, IsMadeOnceForAllParts) {
  succeeds(run(out_, joined(kShotOutputs, {"--shard", "1/2"})));
  const std::string table = read_file(shots_);
  const auto time = fs::last_write_time(shots_);
  succeeds(run(out_, joined(kShotOutputs, {"--shard", "2/2"})));
  EXPECT_EQ(fs::last_write_time(shots_), time);
  succeeds(run_vantage({"merge", out_}));
  EXPECT_EQ(read_file(shots_), table);
  EXPECT_TRUE(same_files(results_in(out_), undisturbed(kShotOutputs)));
}

/// Asked to stop during the survey, it stops there, and goes on with another one.
TEST_F(Survey, MayBeInterrupted) {
  constexpr int kFewFrames = 4;
  for (int frame = kFewFrames; frame < kFrames; ++frame) {
    fs::remove(left_ + "/" + frame_file(frame));
    fs::remove(right_ + "/" + frame_file(frame));
  }
  // Samples then take long, compared with everything before them.
  const Words outputs =
      joined(kShotOutputs, {"--method", "membrane", "--iterations",
                            test_paths::is_sanitized() ? "300" : "2000", "--progress", "bar"});
  const FolderContent expected = undisturbed(outputs);
  const TemporaryFolder streams;
  const VantageProcess process(arguments(out_, outputs), streams.path());
  while (!process.has_ended() && process.err().find("looking for shots") == std::string::npos) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.send(SIGINT);
  const ProcessResult stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("interrupted"));
  EXPECT_THAT(stopped.err, HasSubstr("--resume"));
  EXPECT_THAT(results_in(out_), IsEmpty());
  EXPECT_FALSE(fs::exists(shots_));
  EXPECT_THAT(leftovers_in(out_), IsEmpty());
  succeeds(run(out_, joined(outputs, {"--resume"})));
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

}  // namespace vantage::run_survey_test
