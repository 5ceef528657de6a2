// Commands that get no memory at some allocation, whichever it is.

#include "engine/sequence/steps/frame_slot.h"
#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

namespace vantage::out_of_memory_test {

/// Which blocks are refused: those of images, tables and slots. Smaller ones come from what
/// the process has, and libraries take what fails there for granted.
constexpr std::size_t kLeastBytes = 4096;

class OutOfMemory : public RunTest {
 protected:
  [[nodiscard]] Words failing(int allocation) const {
    return preloaded(
        test_paths::allocation_count(),
        {"ALLOCATION_COUNT=" + counts_, "ALLOCATION_FAIL=" + std::to_string(allocation),
         "ALLOCATION_BYTES=" + std::to_string(kLeastBytes)});
  }
  /// What the command allocates, of such blocks, when nothing happens.
  [[nodiscard]] int allocations(const Words& command) const {
    succeeds(run_vantage(command, failing(0)));
    std::istringstream lines(read_file(counts_));
    std::size_t size = 0;
    int count = 0;
    int sum = 0;
    while (lines >> size >> count) {
      sum += size >= kLeastBytes ? count : 0;
    }
    return sum;
  }
  /// Succeeds with the bytes of `out` that it has undisturbed, or ends in one line without them;
  /// called again with `again` it has them in either case.
  void expect_one_line_or_success(const Words& command, const Words& again, const std::string& out,
                                  int samples) const {
    SCOPED_TRACE(test::sample_name());
    // Those before are of libraries that the system's loader opens.
    const int first = allocations({"--version"}) + 1;
    const int last = allocations(command);
    ASSERT_GT(last, first + 20);
    const FolderContent expected = results_in(out);
    for (const int allocation : sampled_range(first, last, samples, 47)) {
      SCOPED_TRACE("allocation " + std::to_string(allocation));
      fs::remove_all(out);
      fs::create_directory(out);
      const ProcessResult result = run_vantage(command, failing(allocation));
      if (result.exit_code == 0) {
        EXPECT_TRUE(same_files(results_in(out), expected));
        continue;
      }
      expect_one_line(result, 1, command.front());
      for (const auto& [name, bytes] : results_in(out)) {
        EXPECT_TRUE(expected.contains(name) && expected.at(name) == bytes) << name;
      }
      succeeds(run_vantage(again));
      EXPECT_TRUE(same_files(results_in(out), expected));
    }
  }

  void SetUp() override {
    if (test_paths::is_sanitized()) {
      GTEST_SKIP() << "sanitizers have an allocator of their own";
    }
    fs::create_directory(out_);
  }

  std::string counts_ = folder_ / "counts";
  std::string out_ = folder_ / "out";
};

TEST_F(OutOfMemory, RunGoesOn) {
  const Words command =
      arguments(out_, joined(kImageOutputs, {"--frames", "0-5", "--threads", "2", "--quiet"}));
  expect_one_line_or_success(command, joined(command, {"--resume"}), out_, 4);
}

TEST_F(OutOfMemory, MatchAndSynth) {
  const Words pair = {left_ + "/" + frame_file(0),
                      right_ + "/" + frame_file(0),
                      "--disparities=0:9",
                      "--threads",
                      "2",
                      "--quiet",
                      "-o"};
  const Words match = joined({"match"}, joined(pair, {out_ + "/d.png"}));
  const Words synth = joined({"synth"}, joined(pair, {out_ + "/v.png", "--view", "0.5"}));
  expect_one_line_or_success(match, match, out_, 2);
  fs::remove_all(out_);
  fs::create_directory(out_);
  expect_one_line_or_success(synth, synth, out_, 2);
}

/// What holds a frame in flight is made when the first ones are read.
TEST_F(OutOfMemory, NoRoomForAFrame) {
  const std::string bytes = std::to_string(sizeof(FrameSlot));
  for (const int frame : {1, 2}) {
    fs::remove_all(out_);
    const Words command = arguments(out_, {"--method", "ssd", "--in-flight", "2", "--quiet"});
    const ProcessResult result = run_vantage(
        command,
        preloaded(test_paths::allocation_count(),
                  {"ALLOCATION_COUNT=" + counts_, "ALLOCATION_FAIL=" + std::to_string(frame),
                   "ALLOCATION_BYTES=" + bytes, "ALLOCATION_MOST=" + bytes}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_line(result, "run"));
    EXPECT_THAT(result.err, HasSubstr("out of memory"));
  }
}

/// x264 prints a line of its own, and FFmpeg cannot stop it.
TEST_F(OutOfMemory, LibrariesAddNoLine) {
  const ProcessResult result =
      run_vantage(arguments(out_, joined(kVideoOutputs, {"--threads", "1", "--quiet"})),
                  preloaded(test_paths::allocation_count(),
                            {"ALLOCATION_COUNT=" + counts_, "ALLOCATION_FAIL=1",
                             "ALLOCATION_BYTES=1400000", "ALLOCATION_MOST=1600000"}));
  expect_one_line(result, 1, "run", "libx264");
}

}  // namespace vantage::out_of_memory_test
