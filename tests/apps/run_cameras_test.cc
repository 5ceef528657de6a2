// Sequences of more than two cameras: each frame as 'vantage match' matches it.

#include <fstream>

#include "tests/apps/sampling.h"

namespace vantage::run_cameras_test {

class RunCamerasTest : public RunTest {
 protected:
  static constexpr int kFramesUsed = 4;

  RunCamerasTest() {
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
  [[nodiscard]] ProcessResult run(const std::string& out, const Words& more) const {
    return run_vantage(joined(
        {"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9", "--quiet"},
        more));
  }
  /// Of the first frames.
  [[nodiscard]] ProcessResult run_three(const std::string& out, const Words& more) const {
    return run(out, joined({"--more", third_, "--baselines=1,-0.7", "--frames", "0-3",
                            "--chunk-frames", "2"},
                           more));
  }

  std::string third_ = folder_ / "third";
};

TEST_F(RunCamerasTest, FramesAreWhatMatchMakesOfThem) {
  for (const std::string preset : {"realtime", "balanced", "quality"}) {
    const std::string out = folder_ / preset;
    succeeds(run_three(out, {"--preset", preset, "--save", "disparity,confidence,unmatched"}));
    for (const int frame : {0, 3}) {
      const std::string name = frame_file(frame);
      const std::string map = folder_ / (preset + ".pfm");
      succeeds(
          run_vantage({"match", left_ + "/" + name, right_ + "/" + name, third_ + "/" + name, "-o",
                       map, "--baselines=1,-0.7", "--disparities=0:9", "--preset", preset}));
      EXPECT_TRUE(results_in(out)["disparity/" + frame_file(frame, "pfm")] == read_file(map))
          << preset << " frame " << frame;
    }
  }
}

TEST_F(RunCamerasTest, PartsAndResumingChangeNothing) {
  const Words outputs = {"--save", "disparity,right-disparity,views", "--view", "0.5"};
  succeeds(run_three(folder_ / "whole", outputs));
  const std::string parts = folder_ / "parts";
  succeeds(run_three(parts, joined(outputs, {"--shard", "2/2"})));
  succeeds(run_three(parts, joined(outputs, {"--shard", "1/2", "--threads", "1"})));
  EXPECT_TRUE(same_files(results_in(parts), results_in(folder_ / "whole")));

  fs::remove(parts + "/disparity/000002.pfm");
  succeeds(run_vantage({"run", "-o", parts, "--resume", "--frames", "0-3"}));
  EXPECT_TRUE(same_files(results_in(parts), results_in(folder_ / "whole")));

  // Another position of a camera is another run.
  const ProcessResult other = run(parts, {"--more", third_, "--baselines=1,2", "--resume"});
  EXPECT_NE(other.exit_code, 0);
  EXPECT_NE(other.err.find("baselines"), std::string::npos) << other.err;
}

TEST_F(RunCamerasTest, RightMapIsOfTheRightImage) {
  succeeds(run_three(folder_ / "out", {"--reference", "right"}));
  // From the right camera, the left one is at -1, the third one at -1.7.
  const std::string map = folder_ / "map.pfm";
  const std::string name = frame_file(1);
  succeeds(run_vantage({"match", right_ + "/" + name, left_ + "/" + name, third_ + "/" + name, "-o",
                        map, "--baselines=-1,-1.7", "--disparities=0:9"}));
  EXPECT_TRUE(results_in(folder_ / "out")["disparity/000001.pfm"] == read_file(map));
}

TEST_F(RunCamerasTest, ConfigurationFileAndReportNameTheCameras) {
  const ProcessResult printed = succeeds(run_three(folder_ / "out", {"--print-config"}));
  std::ofstream(folder_ / "job.toml") << printed.out;
  const std::string report = folder_ / "report.json";
  succeeds(run_vantage({"run", "--config", folder_ / "job.toml", "--report", report}));
  const nlohmann::json settings = read_json(report)["settings"];
  EXPECT_EQ(settings["baselines"], (std::vector<double>{1, -0.7}));
  EXPECT_EQ(settings["more"], Words{third_});
}

TEST_F(RunCamerasTest, ShorterSequencesAreReported) {
  fs::remove(third_ + "/" + frame_file(kFrames - 1));
  const std::string report = folder_ / "report.json";
  succeeds(run(folder_ / "out", {"--more", third_, "--baselines=1,2", "--report", report}));
  EXPECT_EQ(read_json(report)["results"]["paired"],
            nlohmann::json({{"by", "name"}, {"frames_left_out", {1, 1, 0}}}));
}

TEST_F(RunCamerasTest, RefusesWhatDoesNotGoTogether) {
  const std::vector<Refusal> refusals = {
      {{"--more", third_}, "--baselines has 0 numbers, expected 2"},
      {{"--more", third_, "--baselines", "1"}, "--baselines has 1 number, expected 2"},
      {{"--more", third_, "--baselines=-1,2"}, "right camera is -1, expected a positive"},
      {{"--more", third_, "--baselines", "2,2"}, "are both 2, expected different ones"},
      {{"--more", third_, "--baselines", "1,2", "--selection", "symmetric"},
       "a symmetric solution is of two images"},
      {{"--more", third_, "--baselines", "1,2", "--preset", "realtime", "--reuse", "frame"},
       "expected none with baselines"},
      {{"--more", third_, "--baselines", "1,2", "--preset", "realtime", "--search-size", "half"},
       "--search-size has no effect with several images"},
      {{"--more", third_, "--baselines", "1,2", "--calibration", "rig.yml"},
       "--calibration cannot be used with --baselines"},
      {{"--more", folder_ / "nothing", "--baselines", "1,2"}, "nothing", 1}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(folder_ / "out", words); });
}

}  // namespace vantage::run_cameras_test
