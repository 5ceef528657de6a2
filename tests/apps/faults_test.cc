// Commands whose files, disk or memory fail at any call: each ends well with the right bytes, or in
// one line and without a wrong file, and the same command, or --resume, makes up for it.

#include "engine/sequence/steps/frame_slot.h"
#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

namespace vantage::faults_test {

/// A command below a folder that is its working place: DIR in its words.
struct FaultyCommand {
  std::string name;
  std::string words;
  std::string again;                  ///< words that continue it; empty: the same
  std::vector<std::string> before{};  ///< commands that make what it begins with in DIR/out
};

const std::string kRun =
    "run --left DIR/scene/left --right DIR/scene/right --disparities=0:9 "
    "--threads 2 --chunk-frames 2 --quiet -o DIR/out ";
const std::string kFiles = kRun + "--save disparity,unmatched,preview,views,comfort --view 0.5";
const std::string kVideos =
    kRun + "--save disparity,preview,views --view 0.5 --video preview,views";
const std::string kFilms =
    "run --left DIR/left.mp4 --right DIR/right.mp4 --disparities=0:9 "
    "--threads 2 --quiet --chunk-frames 2 -o DIR/out --save views --view 0.5 "
    "--video views";
const std::string kPair =
    " DIR/scene/left/000000.png DIR/scene/right/000000.png --disparities=0:9 "
    "--threads 2 --quiet ";
const std::string kScene =
    "scene build --images DIR/images --disparities=0:9 --threads 2 --quiet "
    "-o DIR/out";

const std::vector<FaultyCommand>& faulty_commands() {
  static const std::vector<FaultyCommand> commands = {
      {"Run", kFiles, kFiles + " --resume"},
      {"RunVideos", kVideos, kVideos + " --resume"},
      {"RunOfVideos", kFilms, kFilms + " --resume"},
      {"Resume", "run -o DIR/out --resume --quiet --frames all", "", {kVideos + " --frames 0-1"}},
      {"Match",
       "match" + kPair +
           "-o DIR/out/d.pfm --preview DIR/out/p.png --unmatched DIR/out/u.png "
           "--volume DIR/out/v.npy",
       ""},
      {"Synth", "synth" + kPair + "-o DIR/out/v.png --view 0.5", ""},
      {"SynthVideo", "synth" + kPair + "-o DIR/out/v.mp4 --sweep 0:1:3", ""},
      {"SceneBuild", kScene + " --copy-images", ""},
      {"SceneBuildPosed", kScene + " --poses DIR/poses.txt --intrinsics DIR/lens.txt", ""},
      {"Merge", "merge DIR/out --quiet", "", {kVideos + " --shard 1/2", kVideos + " --shard 2/2"}},
      {"Verify", "verify DIR/out --quiet", "", {kFiles}},
      {"GenerateScene", "generate scene -o DIR/out --width 32 --height 24 --quiet --overwrite", ""},
  };
  return commands;
}

class SlowFaults : public testing::TestWithParam<FaultyCommand> {
 protected:
  void SetUp() override {
    if (test_paths::is_sanitized()) {
      GTEST_SKIP() << "sanitizers have an allocator of their own";
    }
    succeeds(
        run_vantage(words_of("generate scene -o DIR/scene --frames 5 --width 32 --height 24 "
                             "--quiet")));
    succeeds(
        run_vantage(words_of("generate scene -o DIR/row --view 0 --view 1 --view 2 --width 32 "
                             "--height 24 --quiet")));
    fs::create_directory(folder_ / "images");
    for (const char* const name : {"/view-0.png", "/view-1.png", "/view-2.png"}) {
      fs::rename(folder_ / "row" + name, folder_ / "images" + name);
    }
    write_file(folder_ / "poses.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
    write_file(folder_ / "lens.txt", "32 32 15.5 11.5\n");  // that of the scene
    for (const char* const film :
         {"-o DIR/left.mp4 --sweep 0:1:4", "-o DIR/right.mp4 --sweep 1:2:4"}) {
      succeeds(run_vantage(words_of("synth" + kPair + film)));
    }
    fs::create_directory(out_);
    for (const std::string& command : GetParam().before) {
      succeeds(run_vantage(words_of(command)));
    }
    fs::copy(out_, before_.path(), fs::copy_options::recursive);
    begin_again();
    begun_ = results_in(out_);
    inputs_ = inputs();
    calls_ = calls_of(command(), folder_.path().string());
    expected_ = results_in(out_);
  }

  [[nodiscard]] Words words_of(const std::string& command) const {
    Words all = words(command);
    for (std::string& word : all) {
      if (word.starts_with("DIR/")) {
        word = folder_ / word.substr(4);
      }
    }
    return all;
  }
  [[nodiscard]] Words command() const { return words_of(GetParam().words); }

  static bool holds(const FolderContent& content, const std::string& name,
                    const std::string& bytes) {
    const auto file = content.find(name);
    return file != content.end() && file->second == bytes;
  }
  void begin_again() const {
    fs::remove_all(out_);
    fs::copy(before_.path(), out_, fs::copy_options::recursive);
  }
  [[nodiscard]] FolderContent inputs() const {
    FolderContent content = results_in(folder_.path());
    std::erase_if(content, [](const auto& file) { return file.first.starts_with("out/"); });
    return content;
  }

  /// Whatever happened, what has a name is whole; and afterwards everything can be had.
  void check(const Words& environment, bool may_leave_files = false) {
    begin_again();
    const ProcessResult result = run_vantage(command(), environment);
    ++faults_;
    EXPECT_TRUE(inputs() == inputs_);
    if (result.exit_code == 0) {
      EXPECT_TRUE(may_leave_files || same_files(results_in(out_), expected_));
    } else {
      ++failures_;
      expect_one_line(result, 1, name_of_command());
      for (const auto& [name, bytes] : results_in(out_)) {
        // What a scene has so far is in its file.
        const bool is_hidden = name.find(".tmp-") != std::string::npos;
        EXPECT_TRUE(name == "scene.json" || (is_hidden && may_leave_files) ||
                    holds(expected_, name, bytes) || holds(begun_, name, bytes))
            << name << " after " << result.err;
      }
    }
    const std::string& again = GetParam().again;
    succeeds(run_vantage(again.empty() ? command() : words_of(again)));
    EXPECT_TRUE(same_files(results_in(out_), expected_)) << "after " << result.err;
  }

  void TearDown() override {
    RecordProperty("faults", faults_);
    RecordProperty("failures", failures_);
    if (runs_everything()) {
      std::cout << GetParam().name << ": " << faults_ << " faults, " << failures_ << " failures\n";
    }
  }

  [[nodiscard]] std::string name_of_command() const {
    const Words all = command();
    const bool has_two_words = all[0] == "scene" || all[0] == "generate";
    return has_two_words ? all[0] + " " + all[1] : all[0];
  }

  TemporaryFolder folder_;
  TemporaryFolder before_;
  std::string out_ = folder_ / "out";
  FolderContent begun_;  ///< what out_ holds at first
  FolderContent inputs_;
  FolderContent expected_;
  FileCalls calls_;
  int faults_ = 0;
  int failures_ = 0;
};

TEST_P(SlowFaults, AnyCallMayFail) {
  SCOPED_TRACE(test::sample_name());
  for (const auto& [name, count] : calls_.counts) {
    for (const int call : sampled_range(1, count, 0, 61)) {
      const std::string fault = name + ":" + std::to_string(call);
      SCOPED_TRACE(fault);
      // What cannot be removed stays.
      check(fault_at("FAIL", fault, folder_.path().string()),
            name == "remove" || name == "unlinkat");
    }
  }
}

TEST_P(SlowFaults, TheDiskMayBeFullFromAnyByteOn) {
  SCOPED_TRACE(test::sample_name());
  std::vector<int> spaces;
  int sum = 0;
  for (const int bytes : calls_.writes) {
    spaces.insert(spaces.end(), {sum, sum + bytes / 2});
    sum += bytes;
  }
  if (spaces.empty()) {
    GTEST_SKIP() << "writes nothing";
  }
  for (const int space : sampled(spaces, 2, 67)) {
    SCOPED_TRACE("space for " + std::to_string(space) + " bytes");
    check(fault_at("SPACE", space, folder_.path().string()));
  }
}

TEST_P(SlowFaults, ReadsAndWritesMayBeShort) {
  for (const int most : {1, 100, -1}) {
    SCOPED_TRACE("at most " + std::to_string(most) + " bytes");
    const int failures = failures_;
    check(fault_at("SHORT", most, folder_.path().string()));
    EXPECT_EQ(failures_, failures);
  }
}

/// Blocks of images, tables and slots: smaller ones come from what the process has, and libraries
/// take what fails there for granted.
TEST_P(SlowFaults, AnyAllocationMayFail) {
  SCOPED_TRACE(test::sample_name());
  constexpr std::size_t kLeastBytes = 4096;
  const TemporaryFolder notes;
  const std::string counts = notes / "counts";
  const auto failing = [&](int allocation) {
    return preloaded(test_paths::allocation_count(),
                     {"ALLOCATION_COUNT=" + counts, "ALLOCATION_FAIL=" + std::to_string(allocation),
                      "ALLOCATION_BYTES=" + std::to_string(kLeastBytes)});
  };
  const auto allocations = [&](const Words& words) {
    succeeds(run_vantage(words, failing(0)));
    std::istringstream lines(read_file(counts));
    std::size_t size = 0;
    int count = 0;
    int sum = 0;
    while (lines >> size >> count) {
      sum += size >= kLeastBytes ? count : 0;
    }
    return sum;
  };
  begin_again();
  // Those before are of libraries that the system's loader opens.
  for (const int allocation :
       sampled_range(allocations({"--version"}) + 1, allocations(command()), 1, 47)) {
    SCOPED_TRACE("allocation " + std::to_string(allocation));
    check(failing(allocation));
  }
}

INSTANTIATE_TEST_SUITE_P(Commands, SlowFaults, testing::ValuesIn(faulty_commands()),
                         [](const auto& one) { return one.param.name; });

class OutOfMemory : public RunTest {};

/// What holds a frame in flight is made when the first ones are read.
TEST_F(OutOfMemory, NoRoomForAFrame) {
  if (test_paths::is_sanitized()) {
    GTEST_SKIP() << "sanitizers have an allocator of their own";
  }
  const std::string bytes = std::to_string(sizeof(FrameSlot));
  for (const int frame : {1, 2}) {
    const Words command =
        arguments(folder_ / "out" + std::to_string(frame), {"--in-flight", "2", "--quiet"});
    const ProcessResult result =
        run_vantage(command, preloaded(test_paths::allocation_count(),
                                       {"ALLOCATION_COUNT=" + (folder_ / "counts"),
                                        "ALLOCATION_FAIL=" + std::to_string(frame),
                                        "ALLOCATION_BYTES=" + bytes, "ALLOCATION_MOST=" + bytes}));
    expect_one_line(result, 1, "run", "out of memory");
  }
}

/// x264 prints a line of its own, and FFmpeg cannot stop it.
TEST_F(OutOfMemory, LibrariesAddNoLine) {
  if (test_paths::is_sanitized()) {
    GTEST_SKIP() << "sanitizers have an allocator of their own";
  }
  const ProcessResult result =
      run_vantage(arguments(folder_ / "out", joined(kVideoOutputs, {"--threads", "1", "--quiet"})),
                  preloaded(test_paths::allocation_count(),
                            {"ALLOCATION_COUNT=" + (folder_ / "counts"), "ALLOCATION_FAIL=1",
                             "ALLOCATION_BYTES=1400000", "ALLOCATION_MOST=1600000"}));
  expect_one_line(result, 1, "run", "libx264");
}

}  // namespace vantage::faults_test
