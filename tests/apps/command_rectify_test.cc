#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/rectification/vertical_error.h"
#include "tests/apps/pair_fixture.h"
#include "tests/engine/unrectified_pair.h"
#include "tests/test_paths.h"

namespace vantage::command_rectify_test {

/// A pair of cameras that are turned by some degrees, as raw-left.png and raw-right.png.
class RectifyTest : public testing::Test {
 protected:
  RectifyTest() {
    write_photograph(left_, pair_.left);
    write_photograph(right_, pair_.right);
  }

  static const test::RenderedPair& shared_pair() {
    static const test::RenderedPair pair = [] {
      Execution execution({.threads = 2});
      return test::unrectified_pair(execution);
    }();
    return pair;
  }
  [[nodiscard]] static ProcessResult rectify(const Words& more) {
    return run_vantage(joined({"rectify"}, more));
  }

  Execution execution_{{.threads = 2}};
  TemporaryFolder folder_;
  const test::RenderedPair& pair_ = shared_pair();
  std::string left_ = folder_ / "raw-left.png";
  std::string right_ = folder_ / "raw-right.png";
};

TEST_F(RectifyTest, FromTheImagesAlone) {
  const std::string out = folder_ / "out";
  const std::string report = folder_ / "report.json";
  const std::string rig = folder_ / "rig.yml";
  const std::string mask = folder_ / "valid.png";
  const ProcessResult result =
      succeeds(rectify({left_, right_, "-o", out, "--report", report, "--matrices", rig,
                        "--valid-mask", mask, "--kept-outline", "1"}));
  EXPECT_THAT(result.err, HasSubstr("rows are off by"));
  EXPECT_THAT(result.err, HasSubstr("disparities "));

  const auto results = read_json(report)["results"];
  EXPECT_EQ(results["pairs"], 1);
  EXPECT_GE(results["matches"].get<int>(), results["inliers"].get<int>());
  EXPECT_GE(results["inliers"].get<int>(), 60);
  EXPECT_LT(results["vertical_error"]["rms_px"].get<double>(), 0.5);
  EXPECT_LT(results["vertical_error"]["systematic_px"].get<double>(), 0.2);
  EXPECT_THAT(result.err, HasSubstr("row error at points that the estimate did not use"));
  EXPECT_LT(results["held_out_vertical_error"]["systematic_px"].get<double>(), 0.5);
  EXPECT_GT(results["covered_share"].get<double>(), 0.5);
  EXPECT_LT(results["valid"]["width"].get<int>(), 320);
  EXPECT_EQ(results["homographies"]["left"].size(), 3U);

  // What was written is as good as was said.
  const Photograph left = read_photograph(fs::path(out) / "raw-left.png");
  const Photograph right = read_photograph(fs::path(out) / "raw-right.png");
  EXPECT_EQ(left.width(), 320);
  const auto error = vertical_error(match_features(left, right));
  ASSERT_TRUE(error);
  EXPECT_LT(error->systematic_px, 0.2);
  const Photograph valid = read_photograph(mask);
  const auto& pixels = std::get<Image<std::uint8_t>>(valid.pixels);
  EXPECT_EQ(pixels.at(160, 120), 255);
  EXPECT_EQ(pixels.at(0, 0), 0);
  EXPECT_EQ(read_stereo_calibration(rig).format, "OpenCV");

  // The matrices are a calibration: the same images come of it.
  const std::string again = folder_ / "again";
  succeeds(rectify({left_, right_, "-o", again, "--calibration", rig, "--kept-outline", "1"}));
  EXPECT_EQ(read_file(fs::path(again) / "raw-left.png"), read_file(fs::path(out) / "raw-left.png"));
  EXPECT_EQ(read_file(fs::path(again) / "raw-right.png"),
            read_file(fs::path(out) / "raw-right.png"));
}

TEST_F(RectifyTest, SeveralPairsGetOneRectificationWhateverTheThreads) {
  for (const char* side : {"left", "right"}) {
    fs::create_directory(folder_ / side);
    for (const char* name : {"000.png", "001.png", "002.png"}) {
      fs::copy_file(std::string(side) == "left" ? left_ : right_, fs::path(folder_ / side) / name);
    }
  }
  std::string first;
  for (const char* threads : {"1", "3"}) {
    const std::string out = folder_ / (std::string("out-") + threads);
    const std::string rig = folder_ / (std::string("rig-") + threads + ".json");
    const ProcessResult result =
        succeeds(rectify({folder_ / "left", folder_ / "right", "-o", out, "--sample-pairs", "2",
                          "--threads", threads, "--matrices", rig}));
    EXPECT_THAT(result.err, HasSubstr("3 pairs of 320x240 pixels"));
    for (const char* name : {"left/000.png", "left/002.png", "right/001.png"}) {
      EXPECT_TRUE(fs::exists(fs::path(out) / name)) << name;
    }
    const std::string all = read_file(rig) + read_file(fs::path(out) / "left/002.png") +
                            read_file(fs::path(out) / "right/000.png");
    if (first.empty()) {
      first = all;
    }
    EXPECT_TRUE(all == first) << threads << " threads";
  }
}

/// Names of the photographs, in folders of their sides where both have one name.
TEST_F(RectifyTest, ImagesKeepTheirNames) {
  const std::string rig = folder_ / "rig.yml";
  succeeds(rectify({left_, right_, "--matrices", rig}));
  for (const char* side : {"a", "b"}) {
    fs::create_directory(folder_ / side);
    fs::copy_file(std::string(side) == "a" ? left_ : right_, fs::path(folder_ / side) / "7 x.png");
  }
  const std::string out = folder_ / "out";
  succeeds(rectify({folder_ / "a/7 x.png", folder_ / "b", "-o", out, "--calibration", rig}));
  EXPECT_THAT(files_below(out), ElementsAre("left/7 x.png", "right/7 x.png"));

  fs::copy_file(left_, folder_ / "a/7 x.PNG");
  fs::copy_file(right_, folder_ / "b/8.png");
  expect_one_line(
      rectify({folder_ / "a", folder_ / "b", "-o", folder_ / "no", "--calibration", rig}), 2,
      "rectify", "would get one name");
  EXPECT_FALSE(fs::exists(folder_ / "no"));
  EXPECT_EQ(rectify({left_, right_, "-o", folder_ / "a/..", "--calibration", rig}).exit_code, 2)
      << "it would replace the photographs";
}

/// Estimated cameras have no scale, and depths in metres are refused, until the baseline is given.
TEST_F(RectifyTest, BaselineGivesTheScale) {
  const std::string rig = folder_ / "rig.yml";
  const std::string report = folder_ / "report.json";
  const ProcessResult without = rectify({left_, right_, "--matrices", rig, "--report", report});
  EXPECT_THAT(without.err, HasSubstr("the cameras have no scale"));
  EXPECT_TRUE(read_json(report)["results"]["baseline_m"].is_null());
  EXPECT_FALSE(read_stereo_calibration(rig).has_scale);
  const Words match = {
      "match",         left_, right_,     "-o", folder_ / "map.pfm", "--depth", folder_ / "z.npy",
      "--calibration", rig,   "--method", "ssd"};
  expect_one_line(run_vantage(match), 1, "match",
                  "has no scale, because its cameras were estimated");
  EXPECT_FALSE(fs::exists(folder_ / "map.pfm"));

  const ProcessResult with = succeeds(rectify({left_, right_, "--matrices", rig, "--report", report,
                                               "--baseline", "0.25", "-o", folder_ / "out"}));
  EXPECT_THAT(with.err, HasSubstr("baseline 0.25 m"));
  EXPECT_DOUBLE_EQ(read_json(report)["results"]["baseline_m"].get<double>(), 0.25);
  EXPECT_NEAR(read_stereo_calibration(rig).baseline(), 0.25, 1e-12);
  EXPECT_EQ(read_stereo_calibration(rig).metres_per_unit, 1);
  // Photographs that `match` rectifies itself, and those that `rectify` did.
  succeeds(run_vantage(match));
  const std::string depths = read_file(folder_ / "z.npy");
  Words again = match;
  again[1] = folder_ / "out/raw-left.png";
  again[2] = folder_ / "out/raw-right.png";
  again.emplace_back("--already-rectified");
  succeeds(run_vantage(again));
  EXPECT_EQ(read_file(folder_ / "z.npy"), depths);
  EXPECT_EQ(rectify({left_, right_, "--matrices", rig, "--baseline", "0"}).exit_code, 2);
}

TEST_F(RectifyTest, ExchangedImagesAreWarnedOf) {
  const std::string report = folder_ / "report.json";
  const auto warned = [&](const Words& arguments) {
    const ProcessResult result = succeeds(run_vantage(joined(arguments, {"--report", report})));
    return result.err.find("warning: left and right look exchanged") != std::string::npos;
  };
  const std::string rig = folder_ / "rig.yml";
  EXPECT_FALSE(warned({"rectify", left_, right_, "-o", folder_ / "pair", "--matrices", rig}));
  EXPECT_FALSE(read_json(report)["results"]["looks_exchanged"].get<bool>());
  EXPECT_TRUE(warned({"rectify", right_, left_, "--matrices", folder_ / "other.yml"}));
  EXPECT_TRUE(read_json(report)["results"]["looks_exchanged"].get<bool>());
  EXPECT_TRUE(warned({"rectify", right_, left_, "-o", folder_ / "wrong", "--calibration", rig}));

  const std::string left = folder_ / "pair/raw-left.png";
  const std::string right = folder_ / "pair/raw-right.png";
  const std::string map = folder_ / "map.pfm";
  EXPECT_FALSE(warned({"match", left, right, "-o", map, "--disparities=0:30", "--method", "ssd"}));
  EXPECT_TRUE(warned({"match", right, left, "-o", map, "--disparities=0:30", "--method", "ssd"}));
  const auto found = read_json(report)["results"]["rectification"];
  EXPECT_TRUE(found["looks_exchanged"].get<bool>());
  EXPECT_GT(found["negative_disparity_share"].get<double>(), 0.9);
  EXPECT_FALSE(warned({"match", right, left, "-o", map, "--disparities=-30:0", "--method", "ssd"}))
      << "whoever asks for negative disparities knows";
  EXPECT_TRUE(warned({"synth", right, left, "-o", folder_ / "view.png", "--view", "0.5",
                      "--disparities=0:30", "--method", "ssd"}));
  EXPECT_TRUE(warned({"run", "--left", right, "--right", left, "-o", folder_ / "run",
                      "--disparities=0:30", "--method", "ssd"}));
  const std::string upper = folder_ / "upper.png";
  const std::string lower = folder_ / "lower.png";
  write_photograph(upper, transposed(read_photograph(left)));
  write_photograph(lower, transposed(read_photograph(right)));
  const ProcessResult vertical = succeeds(run_vantage(
      {"match", lower, upper, "-o", map, "--vertical", "--disparities=0:30", "--method", "ssd"}));
  EXPECT_THAT(vertical.err, HasSubstr("upper and lower look exchanged"));
}

TEST_F(RectifyTest, CalibrationsThatDoNotFitAreWarnedOf) {
  const std::string rig = folder_ / "rig.txt";
  write_file(rig, "P0: 350 0 160 0 0 350 120 0 0 0 1 0\nP1: 350 0 160 -35 0 350 120 0 0 0 1 0\n");
  const ProcessResult result =
      succeeds(rectify({left_, right_, "-o", folder_ / "out", "--calibration", rig}));
  EXPECT_THAT(result.err, HasSubstr("rig.txt (KITTI, cameras 0 and 1)"));
  EXPECT_THAT(
      result.err,
      HasSubstr("rectify: warning: the calibration does not fit the images: rows are off by"));
}

TEST_F(RectifyTest, ErrorsAreOneLine) {
  const auto expect_error = [&](const Words& arguments, int exit_code, const std::string& text) {
    expect_one_line(rectify(arguments), exit_code, "rectify", text);
  };
  const std::string out = folder_ / "out";
  expect_error({left_, right_}, 2, "there is nothing to write");
  expect_error({left_, right_, "-o", out, "--kept-outline", "2"}, 2, "kept-outline is 2");
  expect_error({left_, right_, "-o", out, "--sample-pairs", "0"}, 2, "--sample-pairs is 0");
  expect_error({left_, right_, "--matrices", folder_ / "a.txt"}, 2, "--matrices is");
  expect_error({folder_ / "none.png", right_, "-o", out}, 1, "none.png");

  const std::string flat_file = folder_ / "flat.png";
  write_grey(flat_file, 320, 240, 90);
  expect_error({flat_file, right_, "-o", out}, 1,
               "the images have 0 points in common, expected at least 20");
  EXPECT_FALSE(fs::exists(out)) << "nothing is left behind";

  const std::string small_file = folder_ / "small.png";
  write_grey(small_file, 100, 80, 90);
  expect_error({left_, small_file, "-o", out}, 1, "expected equal sizes");

  // The same photograph from a camera that only turned.
  Eigen::Matrix3d camera = pair_.calibration.left.matrix;
  const std::string turned_file = folder_ / "turned.png";
  write_photograph(
      turned_file,
      test::warped(pair_.left, camera * test::turned_by(0.01, 0.03, 0.02) * camera.inverse()));
  expect_error({left_, turned_file, "-o", out}, 1, "as if the camera had only turned");

  const std::string other_size = folder_ / "other.yml";
  succeeds(rectify({left_, right_, "--matrices", other_size}));
  std::string text = read_file(other_size);
  text.replace(text.find("image_width: 320"), 16, "image_width: 640");
  write_file(other_size, text);
  expect_error({left_, right_, "-o", out, "--calibration", other_size}, 1, "640x240");

  fs::copy_file(left_, folder_ / "left.png");
  expect_error({folder_ / "left.png", right_, "-o", fs::path(folder_ / "left.png").parent_path()},
               2, "which is also an input");
}

TEST_F(RectifyTest, OtherCommandsWarnOfPairsThatAreNotRectified) {
  const std::string map = folder_ / "map.pfm";
  const std::string report = folder_ / "report.json";
  const auto match = [&](const Words& more) {
    return run_vantage(joined({"match", left_, right_, "-o", map, "--disparities=0:20", "--method",
                               "ssd", "--report", report},
                              more));
  };
  const ProcessResult warned = succeeds(match({}));
  EXPECT_THAT(warned.err,
              AllOf(HasSubstr("match: warning: the pair is not rectified: rows are off by"),
                    HasSubstr("% more of the pixels wrong")));
  const auto found = read_json(report)["results"]["rectification"];
  EXPECT_FALSE(found["is_rectified"].get<bool>());
  EXPECT_GT(found["systematic_px"].get<double>(), 5);
  const std::string with_check = read_file(map);

  const ProcessResult unchecked = match({"--no-rectification-check"});
  EXPECT_THAT(unchecked.err, Not(HasSubstr("not rectified")));
  EXPECT_FALSE(read_json(report).contains("results") &&
               read_json(report)["results"].contains("rectification"));
  EXPECT_EQ(read_file(map), with_check);
  EXPECT_THAT(match({"--quiet"}).err, Not(HasSubstr("warning")));

  const ProcessResult synth =
      run_vantage({"synth", left_, right_, "--view", "0.5", "-o", folder_ / "view.png",
                   "--disparities=0:20", "--method", "ssd", "--report", report});
  EXPECT_THAT(synth.err, HasSubstr("synth: warning: the pair is not rectified"));
  EXPECT_TRUE(read_json(report)["results"].contains("rectification"));
  EXPECT_TRUE(read_json(report)["results"].contains("views"));

  const std::string rig = folder_ / "rig.yml";
  succeeds(rectify({left_, right_, "--matrices", rig}));
  for (const bool calibrated : {false, true}) {
    const Words calibration = calibrated ? Words{"--calibration", rig} : Words{};
    const ProcessResult run = succeeds(run_vantage(
        joined({"run", "--left", left_, "--right", right_, "-o",
                folder_ / (calibrated ? "run-c" : "run"), "--disparities=0:20", "--method", "ssd"},
               calibration)));
    EXPECT_EQ(run.err.find("warning: the pair is not rectified") == std::string::npos, calibrated)
        << run.err;
  }
}

TEST_F(RectifyTest, RectifiedPairsAreNotWarnedOf) {
  const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 2}, execution_);
  write_photograph(left_, scene.render({0, 0}, 0).image);
  write_photograph(right_, scene.render({1, 0}, 0).image);
  const std::string report = folder_ / "report.json";
  const ProcessResult result = run_vantage({"match", left_, right_, "-o", folder_ / "map.pfm",
                                            "--disparities=0:20", "--report", report});
  EXPECT_THAT(result.err, Not(HasSubstr("warning")));
  EXPECT_TRUE(read_json(report)["results"]["rectification"]["is_rectified"].get<bool>());
}

TEST(RectifyChessboard, FromFeaturesOfAllPairs) {
  const fs::path folder = test_paths::shared_data("chessboard");
  if (folder.empty()) {
    GTEST_SKIP() << "VANTAGE_SHARED_DATA holds no chessboard";
  }
  const TemporaryFolder out;
  for (const bool calibrated : {false, true}) {
    const std::string report = out / "report.json";
    const Words calibration =
        calibrated ? Words{"--calibration", folder / "stereo_reference.yml"} : Words{};
    succeeds(run_vantage(joined({"rectify", folder / "left0[1-4].jpg", folder / "right0[1-4].jpg",
                                 "--matrices", out / "rig.yml", "--report", report},
                                calibration)));
    const auto error = read_json(report)["results"]["vertical_error"];
    EXPECT_LT(error["rms_px"].get<double>(), 0.5);
    EXPECT_GT(error["inliers"].get<int>(), 300);
  }
}

}  // namespace vantage::command_rectify_test
