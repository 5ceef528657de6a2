// run --pairs with further columns: results are those of `match` with the options of each pair.

#include "tests/apps/sampling.h"

namespace vantage::run_pair_list_test {

/// Cameras of the size of the frames, turned and distorting.
constexpr const char* kTurnedRig = R"(%YAML:1.0
M1: [60, 0, 32, 0, 60, 24, 0, 0, 1]
D1: [-0.1, 0.02, 0.001, -0.002]
M2: [61, 0, 33, 0, 61, 23, 0, 0, 1]
D2: [0.05, -0.01, 0.001, 0.001]
R: [1, 0, 0, 0, 0.99920011, -0.03998933, 0, 0.03998933, 0.99920011]
T: [-0.12, 0.002, 0.001]
)";
constexpr const char* kRectifiedRig =
    "cam0=[60 0 32; 0 60 24; 0 0 1]\ncam1=[60 0 34; 0 60 24; 0 0 1]\ndoffs=2\nbaseline=150\n"
    "width=64\nheight=48\n";

class RunPairList : public RunTest {
 protected:
  RunPairList() {
    fs::create_directory(folder_ / "rigs");
    write_file(folder_ / "rigs/turned.yml", kTurnedRig);
    write_file(folder_ / "rigs/rectified.txt", kRectifiedRig);
  }
  void write_list(const std::string& lines) const { write_file(list_, lines); }
  [[nodiscard]] ProcessResult run_list(const std::string& out, const Words& more) const {
    return run_vantage(
        joined({"run", "--pairs", list_, "-o", out, "--preset", "balanced", "--quiet"}, more));
  }
  /// `match` of frame 2 or another.
  void match_frame(int frame, const Words& more) const {
    succeeds(
        run_vantage(joined({"match", left_ + "/" + frame_file(frame),
                            right_ + "/" + frame_file(frame), "--preset", "balanced", "--quiet"},
                           more)));
  }

  std::string list_ = folder_ / "list.csv";
};

TEST_F(RunPairList, ResultsAreThoseOfMatchWithTheOptionsOfEachPair) {
  write_list(
      "name,left,right,calibration,min-disparity,max-disparity\n"
      "tower,left/000002.png,right/000002.png,rigs/turned.yml,0,12\n"
      "gate,left/000003.png,right/000003.png,rigs/rectified.txt,-2,9\n"
      ",left/000004.png,right/000004.png,rigs/rectified.txt,,\n");
  const Words options = words(
      "--save disparity,depth,depth-resolution,preview --disparities 0:7 --depth-format npy "
      "--calibration-unit m --no-tuning");
  const std::string out = folder_ / "out";
  succeeds(
      run_list(out, joined(options, {"--chunk-frames", "1", "--report", folder_ / "report.json"})));
  const FolderContent made = results_in(out);
  const auto expect_same = [&](int frame, const std::string& name, const std::string& rig,
                               const std::string& range) {
    const std::string at = folder_ / name;
    match_frame(frame,
                {"-o", at + ".pfm", "--depth", at + ".npy", "--depth-resolution", at + "-dz.pfm",
                 "--preview", at + ".png", "--calibration", folder_ / ("rigs/" + rig),
                 "--calibration-unit", "m", "--disparities=" + range, "--no-tuning"});
    EXPECT_TRUE(made.at("disparity/" + name + ".pfm") == read_file(at + ".pfm")) << name;
    EXPECT_TRUE(made.at("depth/" + name + ".npy") == read_file(at + ".npy")) << name;
    EXPECT_TRUE(made.at("depth-resolution/" + name + ".pfm") == read_file(at + "-dz.pfm")) << name;
    EXPECT_TRUE(made.at("preview/" + name + ".png") == read_file(at + ".png")) << name;
  };
  expect_same(2, "tower", "turned.yml", "0:12");
  expect_same(3, "gate", "rectified.txt", "-2:9");
  expect_same(4, "000002", "rectified.txt", "0:7");
  EXPECT_EQ(made.size(), 12U);
  const auto values = read_json(folder_ / "report.json")["results"]["depth_resolution"];
  EXPECT_EQ(values["frames"].size(), 3U);
  EXPECT_FALSE(values.contains("nearest"));  // two scales

  // Names are in the journal: nothing is made again, and a lost file is.
  succeeds(run_vantage({"verify", out}));
  fs::remove(out + "/disparity/gate.pfm");
  const ProcessResult resumed = succeeds(run_vantage({"run", "-o", out, "--resume"}));
  EXPECT_THAT(resumed.err, HasSubstr("2 were already done"));
  EXPECT_TRUE(same_files(results_in(out), made));
  // Parts, in any order.
  const std::string parts = folder_ / "parts";
  for (const char* shard : {"2/2", "1/2"}) {
    succeeds(run_list(parts, joined(options, {"--chunk-frames", "1", "--shard", shard})));
  }
  EXPECT_TRUE(same_files(results_in(parts), made));
  // Another range is another run.
  write_list(
      "name,left,right,calibration,min-disparity,max-disparity\n"
      "tower,left/000002.png,right/000002.png,rigs/turned.yml,0,13\n"
      "gate,left/000003.png,right/000003.png,rigs/rectified.txt,-2,9\n"
      ",left/000004.png,right/000004.png,rigs/rectified.txt,,\n");
  const ProcessResult changed = run_vantage({"run", "-o", out, "--resume"});
  EXPECT_NE(changed.exit_code, 0);
  EXPECT_THAT(changed.err, HasSubstr("columns of the list"));
}

constexpr const char* kKittiRig =
    "P0: 60 0 32 0 0 60 24 0 0 0 1 0\nP1: 60 0 32 -30 0 60 24 0 0 0 1 0\n"
    "P2: 60 0 32 3 0 60 24 0 0 0 1 0\nP3: 60 0 32 -33 0 60 24 0 0 0 1 0\n";

TEST_F(RunPairList, FoldersChooseTheCamerasOfKittiPairByPair) {
  write_file(folder_ / "rigs/kitti.txt", kKittiRig);
  for (const char* name : {"image_2", "image_3"}) {
    fs::copy(name[6] == '2' ? left_ : right_, folder_ / name);
  }
  write_list(
      "left,right,calibration,min-disparity,max-disparity\n"
      "left/000002.png,right/000002.png,rigs/kitti.txt,0,9\n"
      "image_2/000002.png,image_3/000002.png,rigs/kitti.txt,0,9\n");
  const auto depths_of = [&](const std::string& out, const Words& more) {
    const ProcessResult result = succeeds(run_vantage(joined(
        {"run", "--pairs", list_, "-o", out, "--save", "depth", "--depth-format", "npy"}, more)));
    return std::pair(results_in(out), result.err);
  };
  const auto [depths, messages] = depths_of(folder_ / "out", {});
  // All pairs have ranges: none is estimated.
  EXPECT_THAT(messages, Not(HasSubstr("--disparities auto")));
  EXPECT_THAT(messages, HasSubstr("run: 2 pairs, the first of 64x48 pixels, rectified on the fly"));
  EXPECT_THAT(messages, HasSubstr(", disparities of the list, "));
  EXPECT_THAT(messages, HasSubstr("kitti.txt: has KITTI's cameras 0 to 3, and 0 and 1 (grey)"));
  const auto depth_of = [&](const char* cameras) {
    const std::string file = folder_ / "depth.npy";
    succeeds(run_vantage({"match", left_ + "/000002.png", right_ + "/000002.png", "-o",
                          folder_ / "m.pfm", "--quiet", "--calibration", folder_ / "rigs/kitti.txt",
                          "--depth", file, "--disparities", "0:9", "--kitti-cameras", cameras}));
    return read_file(file);
  };
  EXPECT_TRUE(depths.at("depth/000000.npy") == depth_of("0,1"));
  EXPECT_TRUE(depths.at("depth/000001.npy") == depth_of("2,3"));
  const auto [chosen, nothing] = depths_of(folder_ / "chosen", {"--kitti-cameras", "2,3"});
  EXPECT_THAT(nothing, Not(HasSubstr("grey")));
  EXPECT_TRUE(chosen.at("depth/000000.npy") == depths.at("depth/000001.npy"));
}

TEST_F(RunPairList, WhatColumnsDoNotAllowIsRefused) {
  struct Case {
    std::string list;
    Words options;
    std::string message;
    int exit_code = 2;
  };
  const std::string calibrated =
      "left,right,calibration\nleft/000002.png,right/000002.png,rigs/turned.yml\n";
  const std::string ranges =
      "left,right,min-disparity,max-disparity\nleft/000002.png,right/000002.png,0,9\n";
  const std::vector<Case> cases = {
      {"left,right,size\nleft/000002.png,right/000002.png,9\n", {}, "column 'size'", 1},
      {calibrated, {"--view", "0.5"}, "a view is defined by one pair of cameras"},
      {calibrated,
       {"--focal-length", "60", "--baseline", "1", "--save", "depth"},
       "--focal-length is given, but"},
      {calibrated + "left/000003.png,right/000003.png,\n",
       {"--save", "depth", "--calibration-unit", "m"},
       "000003.png has no calibration"},
      {calibrated, {"--save", "depth"}, "turned.yml: does not say how long its unit is", 1},
      {ranges, {"--calibration-unit", "m"}, "--calibration-unit has no effect"},
      {ranges, {"--save", "depth"}, "has no calibration"},
      {ranges, {"--temporal-prior", "1"}, "disparities are passed from frame to frame"},
      {ranges, {"--save", "depth-video"}, "--depth-range MIN:MAX"},
      {"left,right,calibration\nleft/000002.png,right/000002.png,rigs/none.yml\n",
       {},
       "none.yml",
       1},
      {ranges, {"--save", "depth", "--doffs", "3"}, "--doffs has no effect without --focal-length"},
      {ranges, {"--kitti-cameras", "2,3"}, "--kitti-cameras has no effect"},
      {"left,right,min-disparity,max-disparity\nleft/000002.png,right/000002.png,0,9999\n",
       {},
       "000002.png: "},
      {calibrated, {"--unrectified", folder_ / "rigs/turned.yml"}, "its file is of all pairs"}};
  for (const Case& test : cases) {
    write_list(test.list);
    expect_one_line(run_list(folder_ / "wrong", test.options), test.exit_code, "run", test.message);
  }
}

}  // namespace vantage::run_pair_list_test
