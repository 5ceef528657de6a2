// What runs take of memory.

#include <fstream>
#include <sstream>

#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

namespace vantage::run_memory_test {

/// Cameras of large frames, turned and distorting.
constexpr const char* kRig = R"(%YAML:1.0
M1: [380, 0, 199, 0, 380, 150, 0, 0, 1]
D1: [-0.2, 0.05, 0.001, -0.002]
M2: [381, 0, 201, 0, 381, 149, 0, 0, 1]
D2: [0.1, -0.02, 0.001, 0.001]
R: [1, 0, 0, 0, 0.99920011, -0.03998933, 0, 0.03998933, 0.99920011]
T: [-1, 0.02, 0.01]
)";

class SlowRunMemory : public RunTest {
 protected:
  static constexpr int kMany = 400;
  static constexpr int kLargeWidth = 400;
  static constexpr int kLargeHeight = 300;

  void SetUp() override {
    if (test_paths::is_sanitized()) {
      GTEST_SKIP() << "sanitizers have memory of their own";
    }
    add_links(left_, kFrames);
    add_links(right_, kFrames);
    const BookPair pair = make_book_pair({.width_px = kLargeWidth, .height_px = kLargeHeight});
    fs::create_directory(large_left_);
    fs::create_directory(large_right_);
    write_photograph(large_left_ + "/000000.png", pair.left);
    write_photograph(large_right_ + "/000000.png", pair.right);
    std::ofstream(rig_) << kRig;
    add_links(large_left_, 1);
    add_links(large_right_, 1);
    write_file(calibration_,
               "cam0=[400 0 200; 0 400 150; 0 0 1]\ncam1=[400 0 200; 0 400 150; 0 0 1]\n"
               "doffs=0\nbaseline=1\nwidth=400\nheight=300\n");
    write_file(
        pose_,
        "[[view]]\nK = [1600, 0, 800, 0, 1600, 600, 0, 0, 1]\n"
        "R = [0.96, 0, -0.28, 0, 1, 0, 0.28, 0, 0.96]\nt = [0, 0, 0]\nsize = [1600, 1200]\n");
  }

  /// Further names of the files that there are, up to frame kMany.
  static void add_links(const std::string& side, int files) {
    for (int frame = files; frame < kMany; ++frame) {
      fs::create_hard_link(side + "/" + frame_file(frame % files), side + "/" + frame_file(frame));
    }
  }

  [[nodiscard]] nlohmann::json report_of(const Words& arguments,
                                         const Words& environment = {}) const {
    const std::string report = folder_ / "report.json";
    succeeds(run_vantage(joined(arguments, {"--report", report, "--threads", "2"}), environment));
    fs::remove_all(out_);
    return read_json(report);
  }

  [[nodiscard]] Words large_arguments(const Words& more) const {
    return joined(
        {"run", "--left", large_left_, "--right", large_right_, "-o", out_, "--disparities=0:19"},
        more);
  }

  /// Allocations of a run: those of at least `bytes` (a power of two).
  [[nodiscard]] double allocations(const Words& arguments, std::size_t bytes) const {
    const std::string counts = folder_ / "counts";
    (void)report_of(arguments,
                    preloaded(test_paths::allocation_count(), {"ALLOCATION_COUNT=" + counts}));
    std::istringstream lines(read_file(counts));
    std::size_t size = 0;
    double count = 0;
    double sum = 0;
    while (lines >> size >> count) {
      sum += size >= bytes ? count : 0;
    }
    EXPECT_GT(sum, 0);
    return sum;
  }

  /// What a frame adds when all that is reused is there.
  [[nodiscard]] double allocations_per_frame(const Words& arguments, std::size_t bytes,
                                             int few = 50, int more = 100) const {
    const auto up_to = [&](int frames) {
      return allocations(joined(arguments, {"--frames", "0-" + std::to_string(frames - 1)}), bytes);
    };
    return (up_to(more) - up_to(few)) / (more - few);
  }

  std::string out_ = folder_ / "out";
  std::string large_left_ = folder_ / "large-left";
  std::string large_right_ = folder_ / "large-right";
  std::string calibration_ = folder_ / "calib.txt";
  std::string pose_ = folder_ / "pose.toml";
  std::string rig_ = folder_ / "rig.yml";
};

TEST_F(SlowRunMemory, StaysFlat) {
  for (const auto& outputs : {kImageOutputs, joined(kVideoOutputs, {"--temporal-prior", "1"})}) {
    const Words common = arguments(out_, joined(outputs, {"--in-flight", "4"}));
    // The allocator takes some more in the first hundred frames, for blocks of all threads.
    const double few = report_of(joined(common, {"--frames", "0-199"}))["peak_memory_bytes"];
    const double many = report_of(common)["peak_memory_bytes"];
    EXPECT_LT(many, 1.05 * few) << many << " bytes for " << kMany << " frames";
  }
}

TEST_F(SlowRunMemory, IsNotMoreThanAllowed) {
  const std::vector<Words> jobs = {
      {"--frames", "0-15"},
      words("--frames 0-9 --method membrane --iterations 3 --save "
            "disparity,right-disparity,confidence,preview,views,stereo --view 0.5"),
      words("--frames 0-29 --method ssd --save preview,views --view 0.5 --video preview,views"),
      words("--frames 0-15 --method diffusion --iterations 4 --temporal-prior 1"),
      {"--frames", "0-15", "--preset", "realtime", "--reuse", "frame"},
      {"--frames", "0-15", "--method", "ssd", "--calibration", rig_, "--save", "views", "--view",
       "0.5,0.1"}};
  SCOPED_TRACE(test::sample_name());
  SampledNumbers numbers(4);
  for (const Words& job : jobs) {
    const ProcessResult refused =
        run_vantage(large_arguments(joined(job, {"--memory", "10M", "--quiet"})));
    expect_one_line(refused, 1, "run");
    EXPECT_FALSE(fs::exists(out_));
    const std::string says = "memory is 10 MiB, expected at least ";
    const std::size_t min = refused.err.find(says);
    ASSERT_NE(min, std::string::npos) << refused.err;
    const int min_mib = std::stoi(refused.err.substr(min + says.size()));
    std::vector<int> allowed = {min_mib, min_mib * 5 / 4, min_mib * 2};
    if (!test::runs_everything()) {  // the least is what planning has to be exact for
      allowed.erase(allowed.end() - 1 - static_cast<std::ptrdiff_t>(numbers.below(2)));
    }
    for (const int mib : allowed) {
      const nlohmann::json report =
          report_of(large_arguments(joined(job, {"--memory", std::to_string(mib) + "M"})));
      EXPECT_LE(report["peak_memory_bytes"], mib * 1048576.0) << testing::PrintToString(job);
      EXPECT_LE(report["results"]["planned_memory_bytes"], mib * 1048576.0)
          << testing::PrintToString(job);
    }
  }
}

TEST_F(SlowRunMemory, HasOwners) {
  const nlohmann::json report = report_of(large_arguments(words(
      "--frames 0-19 --in-flight 4 --method membrane --iterations 4 --iterations-per-pass 2")));
  const auto owners = report["memory"]["owners"].get<std::map<std::string, double>>();
  for (const char* owner :
       {"program", "frames in flight", "prepared images", "rings", "stored iterations", "other"}) {
    EXPECT_GT(owners.count(owner), 0U) << owner;
  }
  constexpr double kPixels = kLargeWidth * kLargeHeight;
  // Two colour photographs, two maps and the mask of the left one, which is saved, each.
  EXPECT_GE(owners.at("frames in flight"), 4 * kPixels * (2 * 3 + 2 * 4 + 1));
  EXPECT_LE(owners.at("frames in flight"), 4 * kPixels * (2 * 3 + 4 * 4 + 2) * 1.5);
  // Two threads, each with a frame whose 20 candidates take 32 lanes.
  EXPECT_GE(owners.at("stored iterations"), kPixels * 32 * 4);
  EXPECT_LE(owners.at("stored iterations"), 4 * kPixels * 32 * 4);
  double sum = 0;
  for (const auto& [owner, bytes] : owners) {
    EXPECT_LE(bytes, report["peak_memory_bytes"].get<double>()) << owner;
    sum += bytes;
  }
  // "other" is what is left, if anything is; beyond that owners may have had their most apart.
  EXPECT_GE(sum, report["peak_memory_bytes"].get<double>());
  EXPECT_LE(sum, 1.25 * report["peak_memory_bytes"].get<double>());
}

/// Messages, names, tasks, file formats: what a frame allocates is small and does not grow.
TEST_F(SlowRunMemory, FramesAllocateLittle) {
  EXPECT_LT(allocations_per_frame(arguments(out_, {}), 1), 450);
  EXPECT_LT(allocations_per_frame(arguments(out_, kImageOutputs), 1), 800);
  // In which every fiftieth frame begins videos anew.
  EXPECT_LT(allocations_per_frame(
                arguments(out_, words("--save preview,views --view 0.5 --video preview,views")), 1),
            800);
}

/// Pictures on their way from and to files are all that takes blocks of this size anew.
TEST_F(SlowRunMemory, FramesAllocateFewLargeBlocks) {
  const auto per_frame = [&](const Words& more) {
    return allocations_per_frame(large_arguments(more), std::size_t{64} << 10, 20, 45);
  };
  EXPECT_LT(per_frame({"--method", "ssd"}), 12);
  EXPECT_LT(per_frame({}), 16);
  // Matching has its own blocks in the two above.
  EXPECT_LT(per_frame({"--method", "ssd", "--save", "disparity,preview,views", "--view", "0.5"}),
            30);
  EXPECT_LT(per_frame({"--method", "ssd", "--view", "0.5,0.25", "--look-at", "8", "--calibration",
                       calibration_}),
            30);
  EXPECT_LT(per_frame({"--method", "ssd", "--calibration", rig_, "--save",
                       "disparity,preview,views", "--view", "0.5"}),
            30);
}

/// A report is JSON, whose destructors allocate.
TEST_F(SlowRunMemory, EndsInOneLineWhileAReportIsWritten) {
  const Words match = {"match", left_ + "/000000.png", right_ + "/000000.png",
                       "-o",    folder_ / "d.pfm",     "--disparities=0:9"};
  constexpr std::size_t kBytes = 4096;
  const int last = static_cast<int>(allocations(match, kBytes));
  int failures = 0;
  for (int refused = last - 3; refused <= last; ++refused) {
    const ProcessResult result = run_vantage(
        joined(match, {"--threads", "2", "--quiet", "--report", folder_ / "r.json"}),
        preloaded(test_paths::allocation_count(), {"ALLOCATION_FAIL=" + std::to_string(refused),
                                                   "ALLOCATION_BYTES=" + std::to_string(kBytes)}));
    if (result.exit_code != 0) {
      ++failures;
      expect_one_line(result, 1, "match");
    }
  }
  EXPECT_GT(failures, 0);
}

}  // namespace vantage::run_memory_test
