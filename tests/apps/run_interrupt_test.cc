// Runs that are asked to stop, and clocks that jump.

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "engine/io/files/file_descriptor.h"
#include "tests/apps/preloaded.h"

namespace vantage::run_interrupt_test {

class InterruptedRun : public RunTest {
 protected:
  const int frames_ = test_paths::is_sanitized() ? 200 : 400;

  InterruptedRun() {
    for (int frame = kFrames; frame < frames_; ++frame) {
      for (const std::string& side : {left_, right_}) {
        fs::create_hard_link(side + "/" + frame_file(frame % kFrames),
                             side + "/" + frame_file(frame));
      }
    }
  }

  /// Waits until the process has recorded a frame.
  void wait_for_results(const VantageProcess& process) const {
    std::error_code ignored;
    while (!process.has_ended()) {
      for (const auto& entry : fs::directory_iterator(out_ + "/.vantage", ignored)) {
        if (entry.path().extension() == ".jsonl" && fs::file_size(entry.path(), ignored) > 0) {
          return;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  /// Stops the run by `signal` and goes on with it.
  void interrupt(int signal, const Words& outputs) {
    const std::string report = folder_ / "report.json";
    const TemporaryFolder streams;
    const VantageProcess process(
        arguments(out_, joined(outputs, {"--report", report, "--progress", "plain"})),
        streams.path());
    wait_for_results(process);
    process.send(signal);
    const ProcessResult stopped = process.wait();
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("(interrupted, --resume continues)"));
    EXPECT_THAT(leftovers_in(out_), IsEmpty());
    const nlohmann::json results = read_json(report)["results"];
    EXPECT_EQ(results["interrupted"], true);
    const std::vector<int> done = journalled_frames(out_);
    EXPECT_FALSE(done.empty());
    EXPECT_LT(done.size(), static_cast<std::size_t>(frames_));
    // In order and without a gap.
    EXPECT_EQ(done.back() + 1, static_cast<int>(done.size()));
    succeeds(run(out_, joined(outputs, {"--resume", "--report", report})));
    EXPECT_EQ(results["frames"], done.size());
    EXPECT_EQ(read_json(report)["results"]["frames_before"], done.size());
    EXPECT_THAT(leftovers_in(out_), IsEmpty());
    EXPECT_EQ(journalled_frames(out_).size(), static_cast<std::size_t>(frames_));
    expect_maps_of_their_sources();
  }

  void expect_maps_of_their_sources() const {
    const FolderContent maps = results_in(out_ + "/disparity");
    ASSERT_EQ(maps.size(), static_cast<std::size_t>(frames_));
    for (int frame = kFrames; frame < frames_; ++frame) {
      EXPECT_EQ(maps.at(frame_file(frame, "pfm")), maps.at(frame_file(frame % kFrames, "pfm")));
    }
  }

  std::string out_ = folder_ / "out";
};

TEST_F(InterruptedRun, CtrlCFinishesWhatIsUnderWay) {
  interrupt(SIGINT, {});
  fs::remove_all(out_);
  interrupt(SIGTERM, {});
}

TEST_F(InterruptedRun, CtrlCWithVideos) {
  interrupt(SIGINT, {"--save", "disparity,preview", "--video", "preview", "--chunk-frames", "5"});
  EXPECT_FALSE(fs::exists(out_ + "/.vantage/segments"));
  EXPECT_GT(fs::file_size(out_ + "/preview.mp4"), 1000U);
}

/// All frames are of one chunk: nothing of the video is kept, all maps are.
TEST_F(InterruptedRun, ClosingTheTerminalBeforeTheFirstSegmentOfAVideo) {
  const Words outputs = words("--save disparity,preview --video preview --chunk-frames 500");
  interrupt(SIGHUP, outputs);
  EXPECT_GT(fs::file_size(out_ + "/preview.mp4"), 1000U);
}

TEST_F(InterruptedRun, ASecondSignalKills) {
  // A membrane with many iterations: draining would take long.
  const TemporaryFolder streams;
  const VantageProcess process(arguments(out_, {"--method", "membrane", "--iterations", "3000"}),
                               streams.path());
  wait_for_results(process);
  process.send(SIGINT);
  // The first one must have been taken, or both count as one.
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  while (!process.has_ended()) {
    process.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const int exit_code = process.wait().exit_code;
  EXPECT_TRUE(exit_code == 128 + SIGINT || exit_code == 130) << exit_code;
}

/// Nobody reads what the run writes: one signal is enough, as if somebody did.
TEST_F(InterruptedRun, AReaderThatDoesNotReadHoldsNothingUp) {
  for (const int signal : {SIGINT, SIGHUP}) {
    const TemporaryFolder streams;
    const std::string pipe = streams / "stdout";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const FileDescriptor reader(::open(pipe.c_str(), O_RDWR | O_CLOEXEC));
    const std::string report = folder_ / "report.json";
    const VantageProcess process(
        arguments("-", {"--save", "preview", "--method", "ssd", "--report", report}),
        streams.path());
    pollfd room{reader.get(), POLLOUT, 0};
    while (::poll(&room, 1, 0) > 0 && !process.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    process.send(signal);
    for (int wait = 0; wait < 1500 && !process.has_ended(); ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    process.send(SIGKILL);
    fs::remove(pipe);
    write_file(pipe, "");
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_THAT(result.err, HasSubstr("-> standard output (interrupted)"));
    EXPECT_EQ(read_json(report)["results"]["interrupted"], true);
  }
}

using InterruptedMatch = RunTest;

TEST_F(InterruptedMatch, LeavesNoTemporaryFile) {
  const std::string out = folder_ / "out";
  fs::create_directory(out);
  const TemporaryFolder streams;
  const VantageProcess process(
      {"match", left_ + "/" + frame_file(0), right_ + "/" + frame_file(0), "-o", out + "/d.pfm",
       "--volume", out + "/v.npy", "--disparities=0:9", "--method", "membrane", "--iterations",
       "10000"},
      streams.path());
  while (!process.has_ended() && leftovers_in(out).empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  process.send(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  EXPECT_THAT(files_below(out), IsEmpty());
}

class ClockJump : public RunTest {};

TEST_F(ClockJump, NothingChangesButTheDate) {
  const Words outputs = joined(kVideoOutputs, {"--temporal-prior", "1", "--progress", "bar"});
  const FolderContent expected = undisturbed(outputs);
  const std::string out = folder_ / "out";
  const Words environment =
      preloaded(test_paths::clock_jump(), {"CLOCK_JUMP_COUNT=" + (folder_ / "count")});
  const std::string report = folder_ / "report.json";
  const ProcessResult half = succeeds(run_vantage(
      arguments(out, joined(outputs, {"--frames", "0-9", "--report", report})), environment));
  const ProcessResult rest = succeeds(
      run_vantage(arguments(out, joined(outputs, {"--resume", "--report", report})), environment));
  EXPECT_TRUE(same_files(results_in(out), expected));
  for (const ProcessResult& result : {half, rest}) {
    EXPECT_THAT(result.err, HasSubstr(" frames/s"));
    EXPECT_THAT(result.err, Not(ContainsRegex("[ ,]-[0-9]")));
    EXPECT_THAT(result.err, Not(HasSubstr("nan")));
    EXPECT_THAT(result.err, Not(HasSubstr("inf")));
  }
  const nlohmann::json seconds = read_json(report)["seconds"];
  EXPECT_GE(seconds["wall"], 0);
  // No hour has passed, whatever the clock says.
  EXPECT_LT(seconds["wall"], 3600);
  EXPECT_GE(seconds["compute"], 0);
  for (const auto& [stage, time] : seconds["stages"].items()) {
    EXPECT_GE(time, 0) << stage;
    EXPECT_LT(time, 3600) << stage;
  }
}

/// The test above is worth nothing where the library is not loaded.
TEST_F(ClockJump, TheClockDoesJump) {
  const std::string count = folder_ / "count";
  succeeds(run_vantage({"--version"},
                       preloaded(test_paths::clock_jump(), {"CLOCK_JUMP_COUNT=" + count})));
  EXPECT_TRUE(fs::exists(count));
}

}  // namespace vantage::run_interrupt_test
