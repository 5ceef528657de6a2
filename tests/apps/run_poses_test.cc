// New views of sequences from any camera, and along paths.

#include "tests/apps/sampling.h"

namespace vantage::run_poses_test {

/// With the camera half a baseline to the right of the left one, turned, of another size.
constexpr const char* kPoses = R"([[view]]
K = [70, 0, 20, 0, 72, 15, 0, 0, 1]
R = [[0.96, 0, -0.28], [0, 1, 0], [0.28, 0, 0.96]]
t = [-0.48, 0, -0.14]
size = [40, 30]

[[view]]
at = [0.25, -0.5]
)";

/// To the right, down and forward, without turning.
std::string path_to(double x, int last_frame) {
  return "[[view]]\nframe = 0\nK = [60, 0, 32, 0, 60, 24, 0, 0, 1]\n"
         "R = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [0, 0, 0]\n"
         "[[view]]\nframe = " +
         std::to_string(last_frame) +
         "\nK = [60, 0, 32, 0, 60, 24, 0, 0, 1]\nR = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [" +
         std::to_string(-x) + ", -0.5, -1]\n";
}

class RunPoses : public RunTest {
 protected:
  RunPoses() {
    write_file(calibration_,
               "cam0=[60 0 32; 0 60 24; 0 0 1]\ncam1=[60 0 32; 0 60 24; 0 0 1]\ndoffs=0\n"
               "baseline=1\nwidth=64\nheight=48\n");
    write_file(poses_, kPoses);
    write_file(path_, path_to(1, 8));
  }

  [[nodiscard]] Words calibrated(const Words& more) const {
    return joined({"--calibration", calibration_}, more);
  }
  [[nodiscard]] Words all_views(const Words& more) const {
    return joined(calibrated({"--save", "views,holes,sources", "--view", "0.5", "--pose", poses_,
                              "--path", path_}),
                  more);
  }

  std::string calibration_ = folder_ / "calib.txt";
  std::string poses_ = folder_ / "poses.toml";
  std::string path_ = folder_ / "path.toml";
  std::string out_ = folder_ / "out";
};

TEST_F(RunPoses, AreTheViewsOfSynth) {
  succeeds(run(out_, all_views({"--frames", "2-2"})));
  const std::string file = "/" + frame_file(2);
  EXPECT_THAT(files_below(out_ + "/views"),
              ElementsAre("0.25,-0.5" + file, "0.5" + file, "camera-1" + file, "path-1" + file));
  EXPECT_EQ(read_photograph(out_ + "/views/camera-1" + file).width(), 40);

  // A quarter of the way.
  write_file(folder_ / "quarter.toml",
             "[[view]]\nK = [60, 0, 32, 0, 60, 24, 0, 0, 1]\nR = [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
             "t = [-0.25, -0.125, -0.25]\n");
  const std::string poses = kPoses;
  write_file(folder_ / "camera.toml", poses.substr(0, poses.rfind("[[view]]")));
  const std::vector<std::pair<std::string, Words>> views = {
      {"camera-1", {"--pose", folder_ / "camera.toml"}},
      {"path-1", {"--pose", folder_ / "quarter.toml"}},
      {"0.25,-0.5", {"--view", "0.25,-0.5"}}};
  for (const auto& [name, options] : views) {
    succeeds(
        run_vantage(joined({"synth", left_ + file, right_ + file, "--disparities=0:9", "--method",
                            "ssd", "--calibration", calibration_, "-o", folder_ / "v.png",
                            "--hole-mask", folder_ / "h.png", "--source-mask", folder_ / "s.png"},
                           options)));
    for (const auto& [kind, made] :
         {std::pair("views", "v.png"), {"holes", "h.png"}, {"sources", "s.png"}}) {
      EXPECT_EQ(read_file(out_ + "/" + kind + "/" + name + file), read_file(folder_ / made))
          << kind << " " << name;
    }
  }
}

/// Each part with other threads.
TEST_F(RunPoses, PartsAreMergedWithoutTheFiles) {
  const Words outputs = all_views({"--video", "views", "--chunk-frames", "5"});
  succeeds(run(out_, joined(outputs, {"--executor", "serial", "--in-flight", "1"})));
  const FolderContent expected = results_in(out_);
  const std::string parts = folder_ / "parts";
  for (const std::string shard : {"1/3", "2/3", "3/3"}) {
    succeeds(run(parts, joined(outputs, {"--shard", shard, "--threads", shard.substr(0, 1)})));
  }
  fs::remove(poses_);
  fs::remove(path_);
  succeeds(run_vantage({"merge", parts}));
  EXPECT_TRUE(same_files(results_in(parts), expected));
}

TEST_F(RunPoses, OthersAreAnotherRun) {
  const Words some = {"--frames", "0-1"};
  succeeds(run(out_, all_views(some)));
  // What counts is what the file holds.
  fs::rename(path_, folder_ / "same.toml");
  auto renamed = all_views({"--resume", "--frames", "0-2"});
  std::ranges::replace(renamed, path_, std::string(folder_ / "same.toml"));
  succeeds(run(out_, renamed));
  write_file(path_, path_to(0.5, 8));
  expect_one_line(run(out_, all_views({"--resume", "--quiet"})), 1, "run", "path was another one");
  const std::string turned = folder_ / "turned";
  succeeds(run(turned, calibrated({"--view", "0", "--look-at", "4", "--frames", "0-0"})));
  expect_failure(run(turned, calibrated({"--view", "0", "--look-at", "5", "--resume", "--quiet"})),
                 1, "look-at was 4.0, now 5.0");
}

using InputRunPoses = RunPoses;

TEST_F(InputRunPoses, WrongUsageIsOneLine) {
  const std::string bad = folder_ / "bad.toml";
  write_file(bad, "[[view]]\nat = [0.5, 0]\n[[view]]\nat = [17, 0]\n");
  const std::string away = folder_ / "away.toml";
  write_file(away, path_to(1, 4) +
                       "[[view]]\nframe = 9\nK = [60, 0, 32, 0, 60, 24, 0, 0, 1]\n"
                       "R = [-1, 0, 0, 0, 1, 0, 0, 0, -1]\nt = [0, 0, 0]\n");
  const std::vector<Refusal> refusals = {
      {{"--path", path_}, "poses with K, R and t need calibrated cameras, expected --calib"},
      {{"--view", "0.5", "--look-at", "4"}, "--look-at needs the focal length, expected --cal"},
      {calibrated({"--look-at", "4"}), "--look-at has no effect without --view or --view-path"},
      {calibrated({"--look-at", "4", "--pose", poses_}), "turns the cameras of --view and"},
      {calibrated({"--look-at", "-1", "--view", "0"}), "disparity to look at is -1, expected"},
      {{"--pose", bad}, "view is 17, expected numbers within ±16"},
      {{"--pose", path_}, "path.toml: view 1 has a frame, which only --path uses"},
      {{"--path", poses_}, "poses.toml: view 1 has no frame, expected one for every pose"},
      {calibrated({"--view", "0.25,-0.5", "--pose", poses_}), "view 0.25,-0.5 is given twice"},
      {calibrated({"--path", path_, "--save", "disparity"}), "save has no views"},
      {{"--path", folder_ / "absent.toml"}, "absent.toml: cannot be read", 1},
      {calibrated({"--path", away}), "frame 8: camera of the new view looks away", 1}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(out_, joined(words, {"--quiet"})); });
}

TEST_F(RunPoses, SettingsInEffectNameTheFile) {
  const ProcessResult result = succeeds(run(out_, all_views({"--print-config"})));
  EXPECT_THAT(result.out, HasSubstr("pose = '" + poses_ + "'"));
  write_file(folder_ / "job.toml", result.out);
  const ProcessResult planned = succeeds(run_vantage({"run", folder_ / "job.toml", "--dry-run"}));
  EXPECT_THAT(planned.out, HasSubstr("views/camera-1"));
  EXPECT_THAT(planned.out, Not(HasSubstr("path-2")));
}

}  // namespace vantage::run_poses_test
