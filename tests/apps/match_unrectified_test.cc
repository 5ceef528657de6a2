// match --unrectified: what it accepts, reports and refuses.

#include "tests/apps/sampling.h"

namespace vantage::match_unrectified_test {

/// Cameras of the size of the pair, turned and distorting.
constexpr const char* kRig = R"(%YAML:1.0
M1: [70, 0, 35, 0, 70, 26, 0, 0, 1]
D1: [-0.1, 0.02, 0.001, -0.002]
M2: [71, 0, 36, 0, 71, 25, 0, 0, 1]
D2: [0.05, -0.01, 0.001, 0.001]
R: [1, 0, 0, 0, 0.99920011, -0.03998933, 0, 0.03998933, 0.99920011]
T: [-1, 0.02, 0.01]
)";

class MatchUnrectified : public PairTest {
 protected:
  MatchUnrectified() { write_file(rig_, kRig); }
  std::string rig_ = folder_ / "rig.yml";
};

TEST_F(MatchUnrectified, MapsAreOnThePhotographs) {
  succeeds(match(folder_ / "m.pfm",
                 {"--unrectified", rig_, "--output-right", folder_ / "r.pfm", "--confidence",
                  folder_ / "c.pfm", "--unmatched", folder_ / "u.png", "--preview",
                  folder_ / "p.png", "--report", folder_ / "report.json", "--preset", "realtime"}));
  for (const std::string file : {"m.pfm", "r.pfm", "c.pfm"}) {
    EXPECT_THAT(read_file(folder_ / file).substr(0, 9), HasSubstr("Pf\n71 53")) << file;
  }
  const auto report = read_json(folder_ / "report.json");
  EXPECT_EQ(report["settings"]["unrectified"], rig_);
}

TEST_F(MatchUnrectified, MatricesOfRectifyAreACalibration) {
  const std::string matrices = folder_ / "matrices.yml";
  succeeds(run_vantage({"rectify", left_, right_, "--calibration", rig_, "-o",
                        folder_ / "rectified", "--matrices", matrices}));
  succeeds(match(folder_ / "a.pfm", {"--unrectified", rig_}));
  succeeds(match(folder_ / "b.pfm", {"--unrectified", matrices}));
  EXPECT_EQ(read_file(folder_ / "a.pfm"), read_file(folder_ / "b.pfm"));
}

TEST_F(MatchUnrectified, MapsOnRectifiedPixelsMakeViews) {
  succeeds(match(folder_ / "m.pfm", {"--unrectified", rig_, "--rectified-pixels", "--output-right",
                                     folder_ / "r.pfm"}));
  succeeds(run_vantage({"synth", left_, right_, "--calibration", rig_, "--left-disparity",
                        folder_ / "m.pfm", "--right-disparity", folder_ / "r.pfm", "--view", "0.5",
                        "-o", folder_ / "view.png"}));
}

TEST_F(MatchUnrectified, RunMakesTheSame) {
  write_file(folder_ / "list.csv", left_ + "," + right_ + "\n");
  const auto run = [&](const std::string& out, const Words& more) {
    return run_vantage(joined({"run", "--pairs", folder_ / "list.csv", "-o", folder_ / out,
                               "--unrectified", rig_, "--disparities", "0:9", "--quiet"},
                              more));
  };
  const auto file = [&](const std::string& name) { return read_file(folder_ / name); };
  ProcessResult result =
      succeeds(run("maps", {"--save", "disparity,right-disparity,confidence,unmatched"}));
  succeeds(match(folder_ / "m.pfm",
                 {"--unrectified", rig_, "--output-right", folder_ / "r.pfm", "--confidence",
                  folder_ / "c.pfm", "--unmatched", folder_ / "u.png"}));
  EXPECT_TRUE(file("maps/disparity/000000.pfm") == file("m.pfm"));
  EXPECT_TRUE(file("maps/right-disparity/000000.pfm") == file("r.pfm"));
  EXPECT_TRUE(file("maps/confidence/000000.pfm") == file("c.pfm"));
  EXPECT_TRUE(file("maps/unmatched/000000.png") == file("u.png"));

  result = succeeds(run(
      "views", words("--rectified-pixels --save disparity,right-disparity,views,depth --view 0.5 "
                     "--baseline 0.1 --depth-format npy")));
  succeeds(match(folder_ / "m.pfm", {"--unrectified", rig_, "--rectified-pixels", "--output-right",
                                     folder_ / "r.pfm"}));
  EXPECT_TRUE(file("views/disparity/000000.pfm") == file("m.pfm"));
  EXPECT_TRUE(file("views/right-disparity/000000.pfm") == file("r.pfm"));
  succeeds(run_vantage({"synth", left_, right_, "--calibration", rig_, "--left-disparity",
                        folder_ / "m.pfm", "--right-disparity", folder_ / "r.pfm", "--view", "0.5",
                        "-o", folder_ / "view.png"}));
  EXPECT_TRUE(file("views/views/000000.png") == file("view.png"));

  const std::vector<Refusal> refusals = {
      {{"--save", "views", "--view", "0.5"}, "save has views with unrectified"},
      {{"--save", "depth", "--baseline", "1"}, "save has depth with unrectified"},
      {{"--calibration", rig_}, "--calibration and --unrectified are both given"},
      {{"--selection", "symmetric"}, "selection symmetric cannot be used with unrectified"},
      {{"--temporal-prior", "1"}, "temporal-prior cannot be used with unrectified"},
      {{"--save", "posterior-mean"}, "posterior-variance cannot be used with unrectified"},
      {{"--no-tuning"}, "no-tuning has no effect with --unrectified"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run("wrong", words); });
}

TEST_F(MatchUnrectified, RefusesInOneLineAndLeavesNothing) {
  write_file(folder_ / "wrong.yml", "M1: [1]\n");
  const std::vector<Refusal> refusals = {
      {{"--rectified-pixels"}, "--rectified-pixels has no effect without --unrectified"},
      {{"--vertical"}, "--vertical cannot be used with --unrectified"},
      {{"--baselines", "1"}, "--baselines cannot be used with --unrectified"},
      {{"--disparities-y=-1:1"}, "--disparities-y cannot be used with --unrectified"},
      {{"--selection", "symmetric"}, "--selection symmetric cannot be used with"},
      {{"--volume", folder_ / "v.npy"}, "--volume cannot be used with --unrectified"},
      {{"--posterior-mean", folder_ / "v.npy"}, "cannot be used with --unrectified"},
      {{"--unrectified", folder_ / "wrong.yml"}, "wrong.yml", 1},
      {{"--unrectified", folder_ / "missing.yml"}, "missing.yml", 1}};
  expect_refusals("match", folder_.path(), refusals, [&](const Words& words) {
    const bool has_rig = words[0] != "--unrectified" && words[0] != "--rectified-pixels";
    return match(folder_ / "m.pfm",
                 joined(has_rig ? Words{"--unrectified", rig_} : Words(), words));
  });
}

}  // namespace vantage::match_unrectified_test
