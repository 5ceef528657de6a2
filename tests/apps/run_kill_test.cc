// Runs that are killed, and continued until they are done.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "tests/apps/preloaded.h"
#include "tests/apps/run_fixture.h"

namespace vantage {
namespace run_kill_test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using testing::IsEmpty;

constexpr int kKills = kIsSanitized ? 6 : 20;
constexpr int kKilled = 128 + SIGKILL;

/// Execution options of the attempts of a run, taken in turn.
using Ways = std::vector<std::vector<std::string>>;

const std::vector<std::string> kTemporalOutputs =
    joined(kImageOutputs, {"--temporal-prior", "1", "--measure-flicker"});
const std::vector<std::string> kTemporalVideoOutputs =
    joined(kVideoOutputs, {"--temporal-prior", "1", "--measure-flicker"});

class KilledRun : public RunTest {
 protected:
  /// Whatever has a name must be whole, at any time.
  void expect_whole_files(const FolderContent& expected) const {
    for (const auto& [name, bytes] : results_in(out_)) {
      if (fs::path(name).filename().string().front() != '.') {
        const auto whole = expected.find(name);
        EXPECT_TRUE(whole != expected.end() && bytes == whole->second) << name;
      }
    }
    for (const int frame : journalled_frames(out_)) {
      EXPECT_TRUE(fs::exists(out_ + "/disparity/" + frame_file(frame, "pfm"))) << frame;
    }
  }

  void expect_done(const FolderContent& expected) const {
    EXPECT_TRUE(same_files(results_in(out_), expected));
    EXPECT_THAT(leftovers_in(out_), IsEmpty());
    EXPECT_EQ(journalled_frames(out_).size(), static_cast<std::size_t>(kFrames));
  }

  /// Goes on until the run is done.
  void finish(const std::vector<std::string>& outputs, const FolderContent& expected) const {
    const ProcessResult result = run(out_, joined(outputs, {"--resume"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_done(expected);
  }

  /// Kills at moments that are spread over the time that a run takes, from its first results on.
  /// What is killed is continued; what is done before its moment comes begins anew.
  void kill_at_random_moments(const std::vector<std::string>& outputs, const Ways& ways) {
    const Clock::time_point dry = Clock::now();
    ASSERT_EQ(run(out_, joined(outputs, {"--dry-run"})).exit_code, 0);
    const Clock::time_point begin = Clock::now();
    const FolderContent expected = undisturbed(outputs);
    const auto opening = begin - dry;
    const auto working = Clock::now() - begin - opening;
    std::mt19937 generator(20240607);
    for (int kill = 0; kill < kKills; ++kill) {
      const double share = static_cast<double>(generator()) / static_cast<double>(1LL << 32);
      const std::size_t way = static_cast<std::size_t>(kill) % ways.size();
      const TemporaryFolder streams;
      const VantageProcess process(
          arguments(out_, joined(joined(outputs, ways[way]), {"--resume"})), streams.path());
      const auto moment = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             0.9 * opening + share * working);
      while (Clock::now() < moment && !process.has_ended()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      process.send(SIGKILL);
      const ProcessResult result = process.wait();
      if (result.exit_code == kKilled) {
        expect_whole_files(expected);
      } else {
        EXPECT_EQ(result.exit_code, 0) << result.err;
        expect_done(expected);
        fs::remove_all(out_);
      }
    }
    finish(outputs, expected);
  }

  std::string out_ = folder_ / "out";
};

TEST_F(KilledRun, ImagesEndWithTheSameBytes) { kill_at_random_moments(kImageOutputs, {{}}); }

TEST_F(KilledRun, VideosEndWithTheSameBytes) { kill_at_random_moments(kVideoOutputs, {{}}); }

TEST_F(KilledRun, WithATemporalPriorItEndsWithTheSameBytes) {
  kill_at_random_moments(kTemporalOutputs, {{}});
}

TEST_F(KilledRun, EachAttemptMayRunInAnotherWay) {
  kill_at_random_moments(kTemporalVideoOutputs,
                         {{"--executor", "serial", "--in-flight", "1"},
                          {"--executor", "openmp", "--threads", "3", "--in-flight", "5"},
                          {"--executor", "tbb", "--threads", "1", "--in-flight", "2"},
                          {"--executor", "tbb", "--threads", "4", "--in-flight", "8"},
                          {"--executor", "openmp", "--threads", "1", "--strip-width", "16"}});
}

/// Whatever a process was about to do to its files may be what it did not get to.
TEST_F(KilledRun, AnyCallMayBeTheLast) {
  for (const auto& outputs : {kVideoOutputs, kImageOutputs}) {
    const FolderContent expected = undisturbed(outputs);
    std::mt19937 generator(7);
    int killed = 0;
    for (int attempt = 0; attempt < 2 * kKills / 3; ++attempt) {
      const int call = 1 + static_cast<int>(generator() % 120U);
      const ProcessResult result =
          run_vantage(arguments(out_, joined(outputs, {"--resume"})), fault_at("KILL", call, out_));
      if (result.exit_code == kKilled) {
        ++killed;
        expect_whole_files(expected);
      } else {
        EXPECT_EQ(result.exit_code, 0) << result.err;
        expect_done(expected);
        fs::remove_all(out_);
      }
    }
    EXPECT_GT(killed, 0);
    finish(outputs, expected);
    fs::remove_all(out_);
  }
}

/// When all segments are there, joining them and clearing up is all that is left to do: the process
/// is killed before each of the calls that this takes.
TEST_F(KilledRun, JoiningOfVideosMayBeCutOffAnywhere) {
  const FolderContent expected = undisturbed(kVideoOutputs);
  ASSERT_EQ(run(out_, joined(kVideoOutputs, {"--shard", "1/1"})).exit_code, 0);
  ASSERT_FALSE(fs::exists(out_ + "/views.mp4"));
  fs::rename(out_ + "/.vantage/frames-1-of-1.jsonl", out_ + "/.vantage/frames-all.jsonl");
  const std::vector<std::string> again = arguments(out_, joined(kVideoOutputs, {"--resume"}));
  int killed = 0;
  for (int call = 1;; call += kIsSanitized ? 7 : 2) {
    const ProcessResult result = run_vantage(again, fault_at("KILL", call, out_));
    expect_whole_files(expected);
    if (result.exit_code != kKilled) {
      EXPECT_EQ(result.exit_code, 0) << result.err;
      break;
    }
    ++killed;
  }
  EXPECT_GT(killed, kIsSanitized ? 2 : 8);
  finish(kVideoOutputs, expected);
  EXPECT_FALSE(fs::exists(out_ + "/.vantage/segments"));
}

}  // namespace run_kill_test
}  // namespace vantage
