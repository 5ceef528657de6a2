// Sequences of more than two cameras: each frame as 'vantage match' matches it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/apps/run_fixture.h"

namespace vantage {
namespace run_cameras_test {

class RunCamerasTest : public RunTest {
 protected:
  static constexpr int kFramesUsed = 4;

  RunCamerasTest() {
    namespace fs = std::filesystem;
    for (const std::string& side : {left_, right_, third_}) {
      fs::create_directories(side);
    }
    // Any images of the right size do as those of a third camera.
    for (int frame = 0; frame < kFrames; ++frame) {
      fs::copy_file(left_ + "/" + frame_file((frame + 1) % kFrames),
                    third_ + "/" + frame_file(frame));
    }
  }

  /// With the default preset.
  [[nodiscard]] ProcessResult run(const std::string& out,
                                  const std::vector<std::string>& more) const {
    return run_vantage(joined(
        {"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9", "--quiet"},
        more));
  }
  /// Of the first frames.
  [[nodiscard]] ProcessResult run_three(const std::string& out,
                                        const std::vector<std::string>& more) const {
    return run(out, joined({"--more", third_, "--baselines=1,-0.7", "--frames", "0-3",
                            "--chunk-frames", "2"},
                           more));
  }

  std::string third_ = folder_ / "third";
};

TEST_F(RunCamerasTest, FramesAreWhatMatchMakesOfThem) {
  for (const std::string preset : {"realtime", "fast", "balanced", "quality"}) {
    const std::string out = folder_ / preset;
    const ProcessResult result =
        run_three(out, {"--preset", preset, "--save", "disparity,confidence,unmatched"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const int frame : {0, 3}) {
      const std::string name = frame_file(frame);
      const std::string map = folder_ / (preset + ".pfm");
      const ProcessResult matched =
          run_vantage({"match", left_ + "/" + name, right_ + "/" + name, third_ + "/" + name, "-o",
                       map, "--baselines=1,-0.7", "--disparities=0:9", "--preset", preset});
      ASSERT_EQ(matched.exit_code, 0) << matched.err;
      EXPECT_TRUE(results_in(out)["disparity/" + frame_file(frame, "pfm")] == read_file(map))
          << preset << " frame " << frame;
    }
  }
}

TEST_F(RunCamerasTest, PartsAndResumingChangeNothing) {
  const std::vector<std::string> outputs = {"--save", "disparity,right-disparity,views", "--view",
                                            "0.5"};
  ASSERT_EQ(run_three(folder_ / "whole", outputs).exit_code, 0);
  const std::string parts = folder_ / "parts";
  ASSERT_EQ(run_three(parts, joined(outputs, {"--shard", "2/2"})).exit_code, 0);
  ASSERT_EQ(run_three(parts, joined(outputs, {"--shard", "1/2", "--threads", "1"})).exit_code, 0);
  EXPECT_TRUE(same_files(results_in(parts), results_in(folder_ / "whole")));

  std::filesystem::remove(parts + "/disparity/000002.pfm");
  const ProcessResult resumed = run_vantage({"run", "-o", parts, "--resume", "--frames", "0-3"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_TRUE(same_files(results_in(parts), results_in(folder_ / "whole")));

  // Another position of a camera is another run.
  const ProcessResult other = run(parts, {"--more", third_, "--baselines=1,2", "--resume"});
  EXPECT_NE(other.exit_code, 0);
  EXPECT_NE(other.err.find("baselines"), std::string::npos) << other.err;
}

TEST_F(RunCamerasTest, RightMapIsOfTheRightImage) {
  ASSERT_EQ(run_three(folder_ / "out", {"--reference", "right"}).exit_code, 0);
  // From the right camera, the left one is at -1, the third one at -1.7.
  const std::string map = folder_ / "map.pfm";
  const std::string name = frame_file(1);
  ASSERT_EQ(run_vantage({"match", right_ + "/" + name, left_ + "/" + name, third_ + "/" + name,
                         "-o", map, "--baselines=-1,-1.7", "--disparities=0:9"})
                .exit_code,
            0);
  EXPECT_TRUE(results_in(folder_ / "out")["disparity/000001.pfm"] == read_file(map));
}

TEST_F(RunCamerasTest, ConfigurationFileAndReportNameTheCameras) {
  const ProcessResult printed = run_three(folder_ / "out", {"--print-config"});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  std::ofstream(folder_ / "job.toml") << printed.out;
  const std::string report = folder_ / "report.json";
  const ProcessResult result =
      run_vantage({"run", "--config", folder_ / "job.toml", "--report", report});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json settings = read_report(report)["settings"];
  EXPECT_EQ(settings["baselines"], (std::vector<double>{1, -0.7}));
  EXPECT_EQ(settings["more"], std::vector<std::string>{third_});
}

TEST_F(RunCamerasTest, ShorterSequencesAreReported) {
  std::filesystem::remove(third_ + "/" + frame_file(kFrames - 1));
  const ProcessResult result = run(folder_ / "out", {"--more", third_, "--baselines=1,2"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.err.find("camera 3 has frames for 19 pairs, but the first two cameras have 20"),
            std::string::npos)
      << result.err;
}

TEST_F(RunCamerasTest, RefusesWhatDoesNotGoTogether) {
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  for (const Case& test : std::vector<Case>{
           {{"--more", third_}, "--baselines has 0 numbers, expected 2"},
           {{"--more", third_, "--baselines", "1"}, "--baselines has 1 number, expected 2"},
           {{"--more", third_, "--baselines=-1,2"}, "right camera is -1, expected a positive"},
           {{"--more", third_, "--baselines", "2,2"}, "are both 2, expected different ones"},
           {{"--more", third_, "--baselines", "1,2", "--selection", "symmetric"},
            "a symmetric solution is of two images"},
           {{"--more", third_, "--baselines", "1,2", "--preset", "realtime", "--reuse", "frame"},
            "expected none with baselines"},
           {{"--more", third_, "--baselines", "1,2", "--preset", "realtime", "--search-size",
             "half"},
            "--search-size has no effect with several images"},
           {{"--more", third_, "--baselines", "1,2", "--calibration", "rig.yml"},
            "--calibration cannot be used with --baselines"},
           {{"--more", folder_ / "nothing", "--baselines", "1,2"}, "nothing"}}) {
    const ProcessResult result = run(folder_ / "out", test.arguments);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find(test.message), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  }
}

}  // namespace run_cameras_test
}  // namespace vantage
