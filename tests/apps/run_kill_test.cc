// Runs that are killed, and continued until they are done.

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

namespace vantage::run_kill_test {

using Clock = std::chrono::steady_clock;

constexpr int kKilled = 128 + SIGKILL;

/// Kills of a run at moments that nothing chooses but the seed.
std::size_t random_kills() { return test::runs_everything() ? 20 : 5; }

/// Execution options of the attempts of a run, taken in turn.
using Ways = std::vector<Words>;

const Words kTemporalOutputs = joined(kImageOutputs, {"--temporal-prior", "1"});
const Words kTemporalVideoOutputs = joined(kVideoOutputs, {"--temporal-prior", "1"});

class SlowKilledRun : public RunTest {
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
  void finish(const Words& outputs, const FolderContent& expected) const {
    succeeds(run(out_, joined(outputs, {"--resume"})));
    expect_done(expected);
  }

  /// Kills at moments that are spread over the time that a run takes, from its first results on.
  /// What is killed is continued; what is done before its moment comes begins anew.
  void kill_at_random_moments(const Words& outputs, const Ways& ways) {
    SCOPED_TRACE(test::sample_name());
    const Clock::time_point dry = Clock::now();
    succeeds(run(out_, joined(outputs, {"--dry-run"})));
    const Clock::time_point begin = Clock::now();
    succeeds(run(out_, outputs));
    const auto opening = begin - dry;
    const auto working = Clock::now() - begin - opening;
    const FolderContent expected = results_in(out_);
    fs::remove_all(out_);
    SampledNumbers numbers(20240607);
    // One in each part of the time, in an order of the seed's.
    std::vector<double> shares(std::max(random_kills(), ways.size()));
    for (std::size_t i = 0; i < shares.size(); ++i) {
      shares[i] = (static_cast<double>(i) + numbers.share()) / static_cast<double>(shares.size());
      std::swap(shares[i], shares[numbers.below(i + 1)]);
    }
    for (std::size_t kill = 0; kill < shares.size(); ++kill) {
      const TemporaryFolder streams;
      const VantageProcess process(
          arguments(out_, joined(joined(outputs, ways[kill % ways.size()]), {"--resume"})),
          streams.path());
      const auto moment = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             0.9 * opening + shares[kill] * working);
      while (Clock::now() < moment && !process.has_ended()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      process.send(SIGKILL);
      expect_killed_or_done(process.wait(), expected);
    }
    finish(outputs, expected);
  }

  /// What is killed has whole files only; what is not has done all, and is removed. Returns whether
  /// it was killed.
  bool expect_killed_or_done(const ProcessResult& result, const FolderContent& expected) const {
    if (result.exit_code == kKilled) {
      expect_whole_files(expected);
      return true;
    }
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_done(expected);
    fs::remove_all(out_);
    return false;
  }

  std::string out_ = folder_ / "out";
};

TEST_F(SlowKilledRun, ImagesEndWithTheSameBytes) { kill_at_random_moments(kImageOutputs, {{}}); }

TEST_F(SlowKilledRun, VideosEndWithTheSameBytes) { kill_at_random_moments(kVideoOutputs, {{}}); }

TEST_F(SlowKilledRun, WithATemporalPriorItEndsWithTheSameBytes) {
  kill_at_random_moments(kTemporalOutputs, {{}});
}

TEST_F(SlowKilledRun, EachAttemptMayRunInAnotherWay) {
  kill_at_random_moments(kTemporalVideoOutputs,
                         {{"--executor", "serial", "--in-flight", "1"},
                          {"--executor", "openmp", "--threads", "3", "--in-flight", "5"},
                          {"--executor", "tbb", "--threads", "1", "--in-flight", "2"},
                          {"--executor", "tbb", "--threads", "4", "--in-flight", "8"},
                          {"--executor", "openmp", "--threads", "1", "--strip-width", "16"}});
}

/// Whatever a process was about to do to its files may be what it did not get to.
TEST_F(SlowKilledRun, AnyCallMayBeTheLast) {
  SCOPED_TRACE(test::sample_name());
  for (const auto& outputs : {kVideoOutputs, kImageOutputs}) {
    const Words all = arguments(out_, joined(outputs, {"--resume"}));
    const FileCalls calls = calls_of(all, out_);
    ASSERT_GT(calls.count(), 100);
    const FolderContent expected = results_in(out_);
    // Results are written, get their names by renaming, and then their journal is flushed.
    std::vector<int> points = calls.ends_of({"rename", "fdatasync"});
    const std::vector<int> writes = calls.numbers_of("write");
    points.push_back(writes[writes.size() / 2]);
    const std::vector<int> chosen = sampled_range(1, calls.count(), 1, 7, points);
    int killed = 0;
    for (const int call : chosen) {
      fs::remove_all(out_);
      SCOPED_TRACE("killed before call " + std::to_string(call));
      killed += expect_killed_or_done(run_vantage(all, fault_at("KILL", call, out_)), expected);
    }
    // Not all: the last number depends on how results come together.
    EXPECT_GT(killed, static_cast<int>(chosen.size()) / 2);
    // A continued run is one as well.
    for (const double share : {0.6, 0.3}) {
      const int call = 1 + static_cast<int>(share * calls.count());
      expect_killed_or_done(run_vantage(all, fault_at("KILL", call, out_)), expected);
    }
    finish(outputs, expected);
    fs::remove_all(out_);
  }
}

/// When all segments are there, joining them and clearing up is all that is left to do: the process
/// is killed before calls that this takes.
TEST_F(SlowKilledRun, JoiningOfVideosMayBeCutOffAnywhere) {
  SCOPED_TRACE(test::sample_name());
  const std::string prepared = folder_ / "prepared";
  succeeds(run(out_, joined(kVideoOutputs, {"--shard", "1/1"})));
  ASSERT_FALSE(fs::exists(out_ + "/views.mp4"));
  fs::rename(out_ + "/.vantage/frames-1-of-1.jsonl", out_ + "/.vantage/frames-all.jsonl");
  fs::copy(out_, prepared, fs::copy_options::recursive);
  const Words again = arguments(out_, joined(kVideoOutputs, {"--resume"}));
  const FileCalls calls = calls_of(again, out_);
  const FolderContent expected = undisturbed(kVideoOutputs);
  expect_done(expected);
  ASSERT_GT(calls.count(), 8);
  const std::vector<int> chosen =
      sampled_range(1, calls.count(), 3, 3, calls.ends_of({"rename", "unlinkat", "fdatasync"}));
  for (const int call : chosen) {
    fs::remove_all(out_);
    fs::copy(prepared, out_, fs::copy_options::recursive);
    const ProcessResult result = run_vantage(again, fault_at("KILL", call, out_));
    EXPECT_EQ(result.exit_code, kKilled) << call << result.err;
    expect_whole_files(expected);
    if (test::runs_everything() || call == chosen[chosen.size() / 2] || call == chosen.back()) {
      finish(kVideoOutputs, expected);
      EXPECT_FALSE(fs::exists(out_ + "/.vantage/segments"));
    }
  }
}

}  // namespace vantage::run_kill_test
