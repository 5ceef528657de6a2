// Sequences: maps beside the disparity map are those of 'vantage match'.

#include "tests/apps/sampling.h"

namespace vantage::run_further_maps_test {

class RunFurtherMaps : public RunTest {
 protected:
  /// With the default preset.
  [[nodiscard]] ProcessResult run(const std::string& out, const Words& more) const {
    return run_vantage(joined(
        {"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9", "--quiet"},
        more));
  }
  /// `match` of frame 2.
  void match_frame(const Words& more) const {
    succeeds(run_vantage(joined({"match", left_ + "/" + frame_file(2), right_ + "/" + frame_file(2),
                                 "-o", folder_ / "map.pfm", "--disparities=0:9"},
                                more)));
  }
};

TEST_F(RunFurtherMaps, AreThoseOfMatch) {
  const Words frames = {"--frames", "2-3", "--chunk-frames", "1"};
  const std::string moments = folder_ / "moments";
  for (const std::string reference : {"left", "right"}) {
    const std::string out = moments + "-" + reference;
    succeeds(run(out, joined(frames, {"--save", "posterior-mean,posterior-variance", "--reference",
                                      reference})));
    match_frame({"--posterior-mean", folder_ / "mean.pfm", "--posterior-variance",
                 folder_ / "variance.pfm", "--reference", reference});
    EXPECT_TRUE(results_in(out)["posterior-mean/000002.pfm"] == read_file(folder_ / "mean.pfm"));
    EXPECT_TRUE(results_in(out)["posterior-variance/000002.pfm"] ==
                read_file(folder_ / "variance.pfm"));
  }
  const std::string middle = folder_ / "middle";
  succeeds(run(middle, joined(frames, {"--save", "cyclopean,cyclopean-occlusion", "--selection",
                                       "symmetric"})));
  match_frame({"--cyclopean", folder_ / "middle.pfm", "--cyclopean-occlusion",
               folder_ / "middle.png", "--selection", "symmetric"});
  EXPECT_TRUE(results_in(middle)["cyclopean/000002.pfm"] == read_file(folder_ / "middle.pfm"));
  EXPECT_TRUE(results_in(middle)["cyclopean-occlusion/000002.png"] ==
              read_file(folder_ / "middle.png"));
}

/// f b/(d + doffs − δ) − f b/(d + doffs), in metres (EQUATIONS §5.10).
float resolution_of(float d, double step_px) {
  const double from_infinity_px = static_cast<double>(d) + 3;
  return static_cast<float>(500 * 0.2 / (from_infinity_px - step_px) -
                            500 * 0.2 / from_infinity_px);
}

TEST_F(RunFurtherMaps, DepthResolutionsAreThoseOfTheDisparities) {
  write_file(folder_ / "calib.txt",
             "cam0=[500 0 32; 0 500 24; 0 0 1]\ncam1=[500 0 35; 0 500 24; 0 0 1]\ndoffs=3\n"
             "baseline=200\nwidth=64\nheight=48\n");
  write_file(folder_ / "run.toml",
             "save = [\"disparity\", \"depth-resolution\"]\n"
             "disparity-resolution = 0.25\n");
  const std::string out = folder_ / "out";
  const Words outputs = {"--config",       folder_ / "run.toml",
                         "--calibration",  folder_ / "calib.txt",
                         "--chunk-frames", "1",
                         "--frames",       "0-3"};
  succeeds(run(out, joined(outputs, {"--shard", "2/2"})));
  succeeds(run(out, joined(outputs, {"--shard", "1/2", "--report", folder_ / "report.json"})));
  std::vector<float> medians;
  std::vector<float> all;
  const auto values = read_json(folder_ / "report.json")["results"]["depth_resolution"];
  ASSERT_EQ(values["frames"].size(), 4U);
  for (int frame = 0; frame < 4; ++frame) {
    const DisparityMap map = read_disparity(out + "/disparity/" + frame_file(frame, "pfm"));
    const DisparityMap dz = read_disparity(out + "/depth-resolution/" + frame_file(frame, "pfm"));
    std::vector<float> disparities;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        EXPECT_FLOAT_EQ(dz.at(x, y), resolution_of(map.at(x, y), 0.25));
        disparities.push_back(map.at(x, y));
      }
    }
    std::ranges::sort(disparities);
    medians.push_back(disparities[disparities.size() / 2]);
    const auto& entry = values["frames"][frame];
    EXPECT_EQ(entry["frame"], frame);
    EXPECT_EQ(entry["median"]["disparity_px"].get<float>(), medians.back());
    EXPECT_FLOAT_EQ(entry["farthest"]["depth_resolution"].get<float>(),
                    resolution_of(disparities.front(), 0.25));
    all.insert(all.end(), disparities.begin(), disparities.end());
  }
  std::ranges::sort(medians);
  const auto [farthest, nearest] = std::ranges::minmax(all);
  EXPECT_EQ(values["nearest"]["disparity_px"].get<float>(), nearest);
  EXPECT_EQ(values["median"]["disparity_px"].get<float>(), medians[2]);
  EXPECT_EQ(values["farthest"]["disparity_px"].get<float>(), farthest);
  EXPECT_FLOAT_EQ(values["nearest"]["depth"].get<float>(), 100 / (nearest + 3));
  EXPECT_FLOAT_EQ(values["nearest"]["relative_resolution"].get<float>(),
                  resolution_of(nearest, 0.25) * (nearest + 3) / 100);
  EXPECT_EQ(values["disparity_resolution_px"], 0.25);

  // Those of `match`, of the right map, with the default of whole disparities.
  const Words right = words("--reference right --subpixel none --focal-length 500 --baseline 0.2");
  succeeds(run(folder_ / "right",
               joined(right, words("--save depth-resolution --frames 2-2 --format npy"))));
  match_frame(joined(right, {"--depth-resolution", folder_ / "dz.npy"}));
  EXPECT_TRUE(results_in(folder_ / "right")["depth-resolution/000002.npy"] ==
              read_file(folder_ / "dz.npy"));
}

TEST_F(RunFurtherMaps, CloudsMayBeEmpty) {
  const std::string out = folder_ / "out";
  const ProcessResult result = succeeds(RunTest::run(
      out,
      words("--save cloud,mesh --focal-length 500 --baseline 0.2 --max-depth 0.001 --frames 0-0")));
  EXPECT_THAT(result.err, HasSubstr("frame 0: its cloud is empty: no pixel has"));
  EXPECT_THAT(read_file(out + "/cloud/000000.ply"), HasSubstr("\nelement vertex 0\n"));
  EXPECT_THAT(read_file(out + "/mesh/000000.ply"), HasSubstr("\nelement face 0\n"));
}

TEST_F(RunFurtherMaps, PosesAreCountedBeforeTheStart) {
  const std::string out = folder_ / "out";
  const auto run_with = [&](int poses, const Words& more) {
    std::string text;
    for (int i = 0; i < poses; ++i) {
      text += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
    }
    write_file(folder_ / "poses.txt", text);
    return RunTest::run(out, joined({"--save", "cloud", "--focal-length", "500", "--baseline",
                                     "0.2", "--poses", folder_ / "poses.txt"},
                                    more));
  };
  expect_one_line(run_with(5, {"--quiet"}), 1, "run",
                  "has 5 poses, expected one for each pair from 0 to 19");
  EXPECT_FALSE(fs::exists(out));
  // Those of all pairs of the input, whichever are taken.
  EXPECT_THAT(run_with(16, {"--every", "4+1", "--dry-run"}).err, HasSubstr("from 0 to 17"));
  succeeds(run_with(18, {"--every", "4+1", "--dry-run"}));
  succeeds(run_with(5, {"--frames", "1-4", "--dry-run"}));
  EXPECT_THAT(run_with(22, {"--dry-run"}).out, HasSubstr("22 poses for 20 pairs, the last 2 are"));
}

TEST_F(RunFurtherMaps, AreMadeAgainForAVideo) {
  const Words outputs = words(
      "--save disparity,cyclopean-occlusion --selection symmetric --video "
      "cyclopean-occlusion --chunk-frames 5");
  const std::string out = folder_ / "out";
  succeeds(RunTest::run(out, joined(outputs, {"--frames", "0-7"})));
  succeeds(RunTest::run(out, joined(outputs, {"--resume"})));
  EXPECT_TRUE(same_files(results_in(out), undisturbed(outputs)));
}

TEST_F(RunFurtherMaps, AreRefusedWhereThereAreNone) {
  const std::vector<Refusal> refusals = {
      {{"--save", "cyclopean"}, "expected them with selection symmetric only"},
      {{"--save", "posterior-mean", "--method", "ssd"}, "expected the aggregation bayes"},
      {{"--save", "posterior-variance", "--preset", "realtime"}, "expected search-size full"},
      {{"--save", "posterior-variance", "--format", "png"}, "save has posterior-variance"},
      {{"--save", "depth-resolution"}, "--save depth, depth-resolution, cloud or mesh is in"},
      {{"--save", "depth-resolution", "--focal-length", "9", "--baseline", "1", "--format", "png"},
       "save has depth-resolution"},
      {words("--save depth-resolution --focal-length 9 --baseline 1 --disparity-resolution 0"),
       "disparity-resolution is 0, expected a number above 0"},
      {{"--disparity-resolution", "1"}, "where --save has no depth-resolution"},
      {{"--save", "depth-resolution", "--focal-length", "9", "--baseline", "1", "--max-depth", "5"},
       "--max-depth has no effect"},
      {{"--save", "disparity,posterior-mean", "--video", "posterior-mean"},
       "whose values a video cannot hold"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(folder_ / "out", words); });
  for (const std::string option : {"--cyclopean", "--cyclopean-occlusion"}) {
    expect_failure(run_vantage({"match", left_ + "/" + frame_file(0), right_ + "/" + frame_file(0),
                                "-o", folder_ / "map.pfm", option, folder_ / "middle.png"}),
                   2, option + " is given, expected it with --selection");
  }
}

}  // namespace vantage::run_further_maps_test
