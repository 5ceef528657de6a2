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
  std::string again{};                ///< words that continue it; empty: the same
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
const std::string kPosed =
    "scene build --images DIR/row/view-?.png --disparities=0:9 --threads 2 --quiet -o DIR/out "
    "--poses DIR/poses.txt --intrinsics DIR/lens.txt";
const std::string kRow =
    "generate scene -o DIR/row --view 0 --view 1 --view 2 --width 32 --height 24 --quiet";

const std::vector<FaultyCommand>& faulty_commands() {
  static const std::vector<FaultyCommand> commands = {
      {"Run", kFiles, kFiles + " --resume"},
      {"RunVideos", kVideos, kVideos + " --resume"},
      {"RunOfVideos",
       kFilms,
       kFilms + " --resume",
       {"synth" + kPair + "-o DIR/left.mp4 --sweep 0:1:3",
        "synth" + kPair + "-o DIR/right.mp4 --sweep 1:2:3"}},
      {"Resume", "run -o DIR/out --resume --quiet --frames all", "", {kVideos + " --frames 0-1"}},
      {"Overwrite", kFiles + " --preset realtime --overwrite", "", {kFiles}},
      {"Merge", "merge DIR/out --quiet", "", {kVideos + " --shard 1/2", kVideos + " --shard 2/2"}},
      {"Verify", "verify DIR/out --quiet", "", {kFiles}},
      {"Match", "match" + kPair +
                    "-o DIR/out/d.pfm --preview DIR/out/p.png --unmatched DIR/out/u.png "
                    "--volume DIR/out/v.npy"},
      {"Synth", "synth" + kPair + "-o DIR/out/v.png --view 0.5"},
      {"SynthVideo", "synth" + kPair + "-o DIR/out/v.mp4 --sweep 0:1:3"},
      {"View", "view" + kPair + "-o DIR/out/v.html"},
      {"Rectify",
       "rectify DIR/scene/left/000000.png DIR/scene/right/000000.png --quiet --overwrite "
       "--calibration DIR/scene/calib.txt -o DIR/out --matrices DIR/out/m.yml "
       "--valid-mask DIR/out/v.png"},
      {"Reproject",
       "reproject DIR/scene/left-disparity/000000.pfm --calibration DIR/scene/calib.txt --quiet "
       "--depth DIR/out/d.png --cloud DIR/out/c.ply --mesh DIR/out/m.ply"},
      {"SceneBuild",
       "scene build --images DIR/row/view-?.png --disparities=0:9 --threads 2 --quiet "
       "-o DIR/out --copy-images",
       "",
       {kRow}},
      {"SceneBuildPosed", kPosed, "", {kRow}},
      {"SceneView",
       "scene view DIR/out -o DIR/out/v.mp4 --sweep 0:1:3 --quiet",
       "",
       {kRow, kPosed}},
      {"SceneCloud", "scene cloud DIR/out -o DIR/out/c.ply --quiet", "", {kRow, kPosed}},
      {"GenerateScene", "generate scene -o DIR/out --width 32 --height 24 --quiet --overwrite"},
  };
  return commands;
}

/// Smaller blocks come from what the process has, and libraries take what fails there for granted.
constexpr std::size_t kLeastBytes = 4096;

Words refused_allocation(int number, const std::string& counts) {
  return preloaded(test_paths::allocation_count(),
                   {"ALLOCATION_COUNT=" + counts, "ALLOCATION_FAIL=" + std::to_string(number),
                    "ALLOCATION_BYTES=" + std::to_string(kLeastBytes)});
}

/// How many allocations of kLeastBytes there are.
int allocations_of(const Words& words) {
  const TemporaryFolder notes;
  const std::string counts = notes / "counts";
  succeeds(run_vantage(words, refused_allocation(0, counts)));
  std::istringstream lines(read_file(counts));
  std::size_t size = 0;
  int sum = 0;
  for (int count = 0; lines >> size >> count;) {
    sum += size >= kLeastBytes ? count : 0;
  }
  return sum;
}

/// What may fail: calls of a function, allocations …
struct FaultKind {
  std::string name;
  std::vector<int> places;  ///< which call, or from which byte on
  std::function<Words(int place)> environment;
};

std::vector<int> numbers_from(int first, int last) {
  std::vector<int> numbers(static_cast<std::size_t>(std::max(0, last - first + 1)));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

class SlowFaults : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    if (test_paths::is_sanitized()) {
      GTEST_SKIP() << "sanitizers have an allocator of their own";
    }
    write_file(folder_ / "poses.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
    write_file(folder_ / "lens.txt", "32 32 15.5 11.5\n");  // that of the scene
    fs::create_directory(out_);
    succeeds(run_vantage(
        words_of("generate scene -o DIR/scene --frames 3 --width 32 --height 24 --quiet")));
    for (const std::string& before : faulty_.before) {
      succeeds(run_vantage(words_of(before)));
    }
    fs::copy(out_, before_.path(), fs::copy_options::recursive);
    begun_ = results_in(out_);
    inputs_ = inputs();
  }

  /// All that may fail while the command works. Makes expected_.
  std::vector<FaultKind> possible_faults() {
    const std::string folder = folder_.path().string();
    const FileCalls calls = calls_of(command(), folder);
    expected_ = results_in(out_);
    std::vector<FaultKind> kinds;
    for (const auto& [name, count] : calls.counts) {
      kinds.push_back({name, numbers_from(1, count), [=, name = name](int call) {
                         return fault_at("FAIL", name + ":" + std::to_string(call), folder);
                       }});
    }
    std::vector<int> spaces;
    int sum = 0;
    for (const int bytes : calls.writes) {
      spaces.insert(spaces.end(), {sum, sum + bytes / 2});
      sum += bytes;
    }
    if (!spaces.empty()) {
      kinds.push_back(
          {"space", spaces, [=](int bytes) { return fault_at("SPACE", bytes, folder); }});
    }
    kinds.push_back(
        {"short", {1, 100, -1}, [=](int most) { return fault_at("SHORT", most, folder); }});
    begin_again();
    // Those before are of libraries that the system's loader opens.
    const int first = allocations_of({"--version"}) + 1;
    kinds.push_back({"allocation", numbers_from(first, allocations_of(command())),
                     [this](int number) { return refused_allocation(number, notes_ / "counts"); }});
    return kinds;
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
  [[nodiscard]] Words command() const { return words_of(faulty_.words); }

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
  void check(const FaultKind& kind, int place) {
    SCOPED_TRACE(kind.name + " " + std::to_string(place));
    // What cannot be removed stays.
    const bool may_leave_files = kind.name == "remove" || kind.name == "unlinkat";
    const std::string& again = faulty_.again;
    begin_again();
    const ProcessResult result = run_vantage(command(), kind.environment(place));
    EXPECT_TRUE(inputs() == inputs_);
    if (result.exit_code == 0) {
      EXPECT_TRUE(may_leave_files || same_files(results_in(out_), expected_));
      if (again.empty()) {
        return;
      }
    } else {
      ++failures_;
      EXPECT_NE(kind.name, "short");
      expect_one_line(result, 1, name_of_command());
      for (const auto& [name, bytes] : results_in(out_)) {
        // What a scene has so far is in its file.
        const bool is_hidden = name.find(".tmp-") != std::string::npos;
        EXPECT_TRUE(name == "scene.json" || (is_hidden && may_leave_files) ||
                    holds(expected_, name, bytes) || holds(begun_, name, bytes))
            << name << " after " << result.err;
      }
    }
    succeeds(run_vantage(again.empty() ? command() : words_of(again)));
    EXPECT_TRUE(same_files(results_in(out_), expected_)) << "after " << result.err;
  }

  [[nodiscard]] std::string name_of_command() const {
    const Words all = command();
    const bool has_two_words = all[0] == "scene" || all[0] == "generate";
    return has_two_words ? all[0] + " " + all[1] : all[0];
  }

  const FaultyCommand& faulty_ = faulty_commands()[GetParam()];
  TemporaryFolder folder_;
  TemporaryFolder before_;
  TemporaryFolder notes_;
  std::string out_ = folder_ / "out";
  FolderContent begun_;  ///< what out_ holds at first
  FolderContent inputs_;
  FolderContent expected_;
  int failures_ = 0;
};

/// A sample, of the first command of all kinds; with VANTAGE_TEST_ALL everything.
TEST_P(SlowFaults, EndWellOrInOneLine) {
  SCOPED_TRACE(test::sample_name());
  const auto stream = static_cast<std::uint32_t>(GetParam());
  SampledNumbers numbers(stream);
  const std::vector<FaultKind> kinds = possible_faults();
  for (const FaultKind& kind : stream == 0 ? kinds : sampled(kinds, 3, stream)) {
    failures_ = 0;
    const int one = kind.places[numbers.below(kind.places.size())];
    const std::vector<int> places = test::runs_everything() ? kind.places : std::vector{one};
    for (const int place : places) {
      check(kind, place);
    }
    std::cout << faulty_.name << ": " << kind.name << " " << places.size() << ", of which "
              << failures_ << " fail\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Commands, SlowFaults,
                         testing::Range<std::size_t>(0, faulty_commands().size()),
                         [](const auto& one) { return faulty_commands()[one.param].name; });

class SlowJoin : public RunTest {};

/// Videos ended before a segment that could not be read again.
TEST_F(SlowJoin, SegmentsThatCannotBeReadAreNotLeftOut) {
  const std::string out = folder_ / "out";
  const Words command = arguments(
      out, words("--save preview --video preview --chunk-frames 10 --method ssd --quiet"));
  const std::string segment = out + "/.vantage/segments/preview/000010-000019.mp4";
  const int reads = calls_of(command, segment).counts["read"];
  const FolderContent expected = results_in(out);
  EXPECT_GT(reads, 5);
  for (int call = 1; call <= reads; ++call) {
    fs::remove_all(out);
    const ProcessResult result =
        run_vantage(command, fault_at("FAIL", "read:" + std::to_string(call), segment));
    EXPECT_TRUE(result.exit_code == 1 || same_files(results_in(out), expected)) << call;
  }
}

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
