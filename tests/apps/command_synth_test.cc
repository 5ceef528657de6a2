#include <limits>
#include <variant>

#include "engine/image/stereo_packing.h"
#include "engine/io/video/video_io.h"
#include "tests/apps/sampling.h"
#include "tests/engine/engine_test.h"

namespace vantage::command_synth_test {

class SynthCommand : public PairTest {
 protected:
  SynthCommand() {
    write_disparity(left_map_, pair_.left_disparity.view());
    write_disparity(right_map_, pair_.right_disparity.view());
    outputs_ = folder_ / "out";
    fs::create_directory(outputs_);
  }

  [[nodiscard]] ProcessResult synth(const Words& more) const {
    return run_vantage(joined({"synth", left_, right_, "--quiet"}, more));
  }
  [[nodiscard]] ProcessResult synth_from_maps(const Words& more) const {
    return synth(joined(more, {"--left-disparity", left_map_, "--right-disparity", right_map_}));
  }

  std::string left_map_ = folder_ / "left.pfm";
  std::string right_map_ = folder_ / "right.npy";
  std::string outputs_;
};

// By default, and whatever the other image's exposure is.
TEST_F(SynthCommand, TheViewAtACameraIsItsImage) {
  auto& right = std::get<Image<std::uint8_t>>(pair_.right.pixels);
  for (int y = 0; y < right.height(); ++y) {
    std::transform(right.row(y), right.row(y) + right.width(), right.row(y),
                   [](int value) { return static_cast<std::uint8_t>(40 + value / 2); });
  }
  write_photograph(right_, pair_.right);
  DisparityMap left_map = pair_.left_disparity.copy();
  left_map.at(20, 30) = std::numeric_limits<float>::quiet_NaN();
  write_disparity(left_map_, left_map.view());
  succeeds(synth_from_maps({"-o", outputs_ + "/v%01d.png", "--view", "0", "--view", "1"}));
  EXPECT_TRUE(test::same(read_photograph(outputs_ + "/v0.png"), pair_.left));
  EXPECT_TRUE(test::same(read_photograph(outputs_ + "/v1.png"), pair_.right));
}

TEST_F(SynthCommand, SeveralViewsNeedAPattern) {
  const Words views = {"--view", "0.25", "--view", "-0.5", "--view=0.75,0"};
  succeeds(synth_from_maps(joined(views, {"-o", outputs_ + "/v%02d.png", "--hole-mask",
                                          outputs_ + "/m%d.png", "--report", folder_ / "r.json"})));
  EXPECT_THAT(files_below(outputs_),
              ElementsAre("m0.png", "m1.png", "m2.png", "v00.png", "v01.png", "v02.png"));
  const auto report = read_json(folder_ / "r.json");
  EXPECT_EQ(report["results"]["views"].size(), 3U);
  EXPECT_EQ(report["results"]["views"][1]["view_x"], -0.5);
  EXPECT_EQ(report["results"]["views"][1]["view_y"], 0);
  // One brightness for all of them.
  EXPECT_EQ(report["results"]["views"][0]["intensity"], report["results"]["views"][2]["intensity"]);
  EXPECT_TRUE(report["plan"].is_null());  // the maps were given

  expect_one_line(synth_from_maps(joined(views, {"-o", outputs_ + "/plain.png"})), 2, "synth",
                  "expected a pattern such as views/%03d.png");
}

TEST_F(SynthCommand, MatchesThePairWithoutMaps) {
  succeeds(synth({"-o", outputs_ + "/v.png", "--view", "0.5", "--disparities", "0:9", "--method",
                  "ssd", "--report", folder_ / "r.json"}));
  const auto report = read_json(folder_ / "r.json");
  EXPECT_EQ(report["cells"], 71.0 * 53 * 10 * 2);
  EXPECT_TRUE(report["seconds"]["stages"].contains("views"));
}

TEST_F(SynthCommand, SweepsBecomeVideosAndEqualTheirViews) {
  succeeds(synth_from_maps({"-o", outputs_ + "/v.mp4", "--sweep", "-0.5:1:4", "--fps", "29.97"}));
  VideoReader reader(outputs_ + "/v.mp4");
  Photograph frame;
  int frames = 0;
  while (reader.read(frame)) {
    ++frames;
  }
  EXPECT_EQ(frames, 4);
  EXPECT_EQ(reader.frame_rate(), (FrameRate{30000, 1001}));

  succeeds(synth_from_maps({"-o", outputs_ + "/s%d.png", "--sweep", "-0.5:1:4"}));
  succeeds(synth_from_maps({"-o", outputs_ + "/half.png", "--view", "0.5"}));
  EXPECT_EQ(read_file(outputs_ + "/s2.png"), read_file(outputs_ + "/half.png"));
  EXPECT_THAT(files_below(outputs_),
              ElementsAre("half.png", "s0.png", "s1.png", "s2.png", "s3.png", "v.mp4"));
}

TEST_F(SynthCommand, OptionsReachTheSynthesis) {
  const auto view = [&](const Words& options) {
    succeeds(synth_from_maps(joined({"-o", outputs_ + "/v.png", "--view", "3"}, options)));
    return read_file(outputs_ + "/v.png");
  };
  const std::string usual = view({});
  EXPECT_NE(view({"--holes", "mirror"}), usual);
  EXPECT_NE(view({"--holes", "spread"}), usual);
  EXPECT_NE(view({"--holes", "none"}), usual);
  EXPECT_NE(view({"--holes", "inpaint"}), usual);
  EXPECT_NE(view({"--holes", "texture"}), usual);
  EXPECT_NE(view({"--soft-edges", "off"}), usual);
  EXPECT_EQ(view({"--holes", "interpolate", "--warp", "one-pass", "--gamma", "0.5"}), usual);
  EXPECT_EQ(view({"--soft-edges", "on"}), usual);
}

TEST_F(SynthCommand, SourceMaskNamesTheImages) {
  succeeds(
      synth_from_maps({"-o", outputs_ + "/v.png", "--view", "0.5", "--soft-edges", "off",
                       "--hole-mask", outputs_ + "/h.png", "--source-mask", outputs_ + "/s.png"}));
  const Photograph holes = read_photograph(outputs_ + "/h.png");
  const Photograph sources = read_photograph(outputs_ + "/s.png");
  int both = 0;
  for (int y = 0; y < sources.height(); ++y) {
    for (int x = 0; x < sources.width(); ++x) {
      const int value = std::get<Image<std::uint8_t>>(sources.pixels).at(x, y);
      EXPECT_EQ(value == 0, std::get<Image<std::uint8_t>>(holes.pixels).at(x, y) == 255);
      EXPECT_TRUE(value == 0 || value == 85 || value == 170 || value == 255) << value;
      both += value == 255 ? 1 : 0;
    }
  }
  EXPECT_GT(both, sources.width() * sources.height() / 2);
}

using InputSynthCommand = SynthCommand;

TEST_F(InputSynthCommand, WrongUsageIsOneLineAndExit2) {
  const std::string out = outputs_ + "/v.png";
  const std::vector<Refusal> refusals = {
      {{"-o", out}, "no view is given"},
      {{"-o", out, "--view", "0.5,0.25,1"}, "--view is '0.5,0.25,1', expected a position XS or"},
      {{"-o", out, "--view", "middle"}, "--view is"},
      {{"-o", out, "--view", "17"}, "--view is '17', expected a position XS or"},
      {{"-o", out, "--view", "0.5", "--sweep", "0:1:3"}, "views are given in several ways"},
      {{"-o", out, "--orbit", "0:9"}, "--orbit is '0:9', expected RADIUS:VIEWS"},
      {{"-o", out, "--view", "0.5", "--look-at", "4"}, "expected --calibration"},
      {{"-o", out, "--pose", "absent.toml", "--look-at", "4"}, "--look-at turns the cameras of"},
      {{"-o", out, "--view", "0.5", "--eye-separation", "0.5"}, "no effect without --stereo-pa"},
      {{"-o", out, "--view", "0.5", "--kept-outline", "0.5"}, "no effect without --calibration"},
      {{"-o", out, "--view", "0.5", "--stereo-packing", "arcd", "--eye-separation", "0"},
       "--eye-separation is 0, expected more than 0"},
      {{"-o", out, "--view", "0.5", "--stereo-packing", "abl", "--hole-mask", out + ".png"},
       "expected no --stereo-packing"},
      {{"-o", out, "--sweep", "0:1"}, "--sweep is '0:1'"},
      {{"-o", out, "--sweep", "0:1:1"}, "--sweep is '0:1:1'"},
      {{"-o", outputs_ + "/%s.png", "--sweep", "0:1:3"}, "expected one %d"},
      {{"-o", outputs_ + "/%d%d.png", "--sweep", "0:1:3"}, "expected one %d"},
      {{"-o", outputs_ + "/%d.mp4", "--sweep", "0:1:3"}, "expected one video file"},
      {{"-o", outputs_ + "/v.mp4", "--sweep", "0:1:3", "--fps", "0"}, "--fps is"},
      {{"-o", outputs_ + "/v.mp4", "--sweep", "0:1:3", "--fps", "30/0"}, "--fps is"},
      {{"-o", outputs_ + "/v.gif", "--view", "0.5"}, "v.gif"},
      {{"-o", out, "--view", "0.5", "--left-disparity", left_map_}, "--right-disparity is missing"},
      {{"-o", out, "--view", "0.5", "--left-disparity", left_map_, "--right-disparity", right_map_,
        "--window", "5"},
       "--window has no effect"},
      {{"-o", out, "--view", "0.5", "--gamma", "2"}, "gamma"},
      {{"-o", out, "--view", "0.5", "--gradient-limit", "-1"}, "gradient"}};
  expect_refusals("synth", folder_.path(), refusals,
                  [&](const Words& words) { return synth(words); });
}

TEST_F(SynthCommand, PosesOfAFileAreTheViewsTheyName) {
  write_file(folder_ / "poses.toml", "[[view]]\nat = [0.25, 0]\n[[view]]\nat = [0.5, -0.25]\n");
  write_file(folder_ / "poses.json", R"({"view": [{"at": [0.25, 0]}, {"at": [0.5, -0.25]}]})");
  write_file(folder_ / "path.toml",
             "[[view]]\nframe = 0\nat = [0, 0]\n[[view]]\nframe = 2\nat = [0.5, 0]\n");
  const std::vector<Words> runs = {
      {"-o", outputs_ + "/t%d.png", "--pose", folder_ / "poses.toml"},
      {"-o", outputs_ + "/j%d.png", "--pose", folder_ / "poses.json"},
      {"-o", outputs_ + "/v%d.png", "--view", "0.25", "--view", "0.5,-0.25"},
      {"-o", outputs_ + "/p%d.png", "--path", folder_ / "path.toml"}};
  for (const auto& arguments : runs) {
    succeeds(synth_from_maps(arguments));
  }
  for (const char* number : {"0.png", "1.png"}) {
    EXPECT_EQ(read_file(outputs_ + "/t" + number), read_file(outputs_ + "/v" + number));
    EXPECT_EQ(read_file(outputs_ + "/j" + number), read_file(outputs_ + "/v" + number));
  }
  EXPECT_EQ(read_file(outputs_ + "/p1.png"), read_file(outputs_ + "/v0.png"));
  EXPECT_FALSE(fs::exists(outputs_ + "/p3.png"));
}

TEST_F(SynthCommand, CamerasAndTurnedViewsNeedACalibration) {
  write_file(folder_ / "calib.txt",
             "cam0=[80 0 35; 0 80 26; 0 0 1]\ncam1=[80 0 35; 0 80 26; 0 0 1]\ndoffs=0\n"
             "baseline=2\nwidth=71\nheight=53\n");
  write_file(
      folder_ / "camera.toml",
      "[[view]]\nK = [80, 0, 35, 0, 80, 26, 0, 0, 1]\nR = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
      "t = [-1, 0, 0]\n");
  const Words camera = {"-o", outputs_ + "/c.png", "--pose", folder_ / "camera.toml"};
  expect_failure(synth_from_maps(camera), 2, "need calibrated cameras, expected --calibration");

  succeeds(synth_from_maps(joined(camera, {"--calibration", folder_ / "calib.txt"})));
  succeeds(synth_from_maps({"-o", outputs_ + "/b.png", "--view", "0.5"}));
  EXPECT_EQ(read_file(outputs_ + "/c.png"), read_file(outputs_ + "/b.png"));
  // Straight ahead of the middle the camera need not turn.
  succeeds(synth_from_maps({"-o", outputs_ + "/l.png", "--view", "0.5", "--look-at", "4",
                            "--calibration", folder_ / "calib.txt"}));
  EXPECT_EQ(read_file(outputs_ + "/l.png"), read_file(outputs_ + "/b.png"));
  succeeds(synth_from_maps({"-o", outputs_ + "/t.png", "--view", "0.75", "--look-at", "4",
                            "--calibration", folder_ / "calib.txt"}));
  EXPECT_EQ(read_photograph(outputs_ + "/t.png").width(), 71);
  // The book's three steps instead of one.
  succeeds(synth_from_maps({"-o", outputs_ + "/f.png", "--view", "0.75", "--look-at", "4",
                            "--calibration", folder_ / "calib.txt", "--warp", "forward"}));
  EXPECT_NE(read_file(outputs_ + "/f.png"), read_file(outputs_ + "/t.png"));
}

TEST_F(InputSynthCommand, WhatIsWrongInAFileOfPosesIsNamed) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"", "expected a list 'view' of poses"},
      {"[[view]]\nxy = [0, 0]", "p.toml: view 1: unknown key 'xy', expected one of"},
      {"[[view]]\nat = [0]", "p.toml: view 1: at is [0], expected a list of 2 numbers"},
      {"[[view]]\nat = [0, 0]\n[[view]]\nK = 1", "p.toml: view 2 has no R, expected at = [XS, YS]"},
      {"[[view]]\nat = [0, 0]\nsize = [3, 4]", "p.toml: view 1 has both 'at' and 'size'"},
      {"[[view]]\nat = [0, 0]\nframe = 1", "p.toml: view 1 has a frame, which only --path uses"},
      {"[[view]", "not TOML"}};
  for (const auto& [text, says] : files) {
    write_file(folder_ / "p.toml", text);
    expect_one_line(synth_from_maps({"-o", outputs_ + "/v.png", "--pose", folder_ / "p.toml"}), 2,
                    "synth", says);
  }
  const ProcessResult path =
      synth_from_maps({"-o", outputs_ + "/v.mp4", "--path", folder_ / "absent.toml"});
  EXPECT_EQ(path.exit_code, 1);
  EXPECT_THAT(files_below(outputs_), IsEmpty());
}

/// Before the views that come ahead of it are written.
TEST_F(InputSynthCommand, APoseThatCannotBeRenderedIsFoundFirst) {
  write_file(folder_ / "calib.txt",
             "cam0=[80 0 35; 0 80 26; 0 0 1]\ncam1=[80 0 35; 0 80 26; 0 0 1]\ndoffs=0\n"
             "baseline=2\nwidth=71\nheight=53\n");
  const std::string usual =
      "[[view]]\nK = [80, 0, 35, 0, 80, 26, 0, 0, 1]\nR = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
      "t = [-1, 0, 0]\n";
  const auto camera = [&](const std::string& turn, const std::string& place) {
    return "[[view]]\nK = [80, 0, 35, 0, 80, 26, 0, 0, 1]\nR = " + turn + "\nt = " + place + "\n";
  };
  const std::string straight = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
  struct Case {
    std::string last;
    Words more;
    std::string says;
  };
  const std::vector<Case> cases = {
      {"[[view]]\nat = [2.5e5, 0]\n", {}, "view 3: view is at 250000, 0 baselines"},
      {"[[view]]\nat = [0, -17]\n", {}, "view 3: view is at 0, -17 baselines"},
      {"[[view]]\nat = [15.9, 0]\n", {"--stereo-packing", "sbsl"}, "view 3: view is at 16.4"},
      {camera(straight, "[-400, 0, 0]"), {}, "view 3: camera of the new view is 200 baselines"},
      {camera("[[-1, 0, 0], [0, 1, 0], [0, 0, -1]]", "[0, 0, 0]"), {}, "view 3: camera of the new"},
      {camera("[[0, 0, 1], [0, 1, 0], [-1, 0, 0]]", "[0, 0, 1]"),
       {"--warp", "forward"},
       "view 3: "}};
  for (const auto& [last, more, says] : cases) {
    write_file(folder_ / "p.toml", usual + usual + last);
    const ProcessResult result =
        synth_from_maps(joined({"-o", outputs_ + "/v%d.png", "--calibration", folder_ / "calib.txt",
                                "--pose", folder_ / "p.toml"},
                               more));
    EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << last;
    EXPECT_TRUE(is_one_line(result, "synth"));
    EXPECT_THAT(result.err, HasSubstr(says));
    EXPECT_THAT(files_below(outputs_), IsEmpty()) << last;
  }
}

TEST_F(SynthCommand, TwoEyesBecomeOnePicture) {
  succeeds(synth_from_maps({"-o", outputs_ + "/s.png", "--view", "0.5", "--eye-separation", "0.5",
                            "--stereo-packing", "sbsl", "--no-intensity-matching"}));
  succeeds(synth_from_maps({"-o", outputs_ + "/e%d.png", "--view", "0.25", "--view", "0.75",
                            "--no-intensity-matching"}));
  Photograph left;
  Photograph right;
  unpack_stereo(read_photograph(outputs_ + "/s.png"), {}, left, right);
  write_photograph(outputs_ + "/l.png", left);
  write_photograph(outputs_ + "/r.png", right);
  EXPECT_EQ(read_file(outputs_ + "/l.png"), read_file(outputs_ + "/e0.png"));
  EXPECT_EQ(read_file(outputs_ + "/r.png"), read_file(outputs_ + "/e1.png"));
}

TEST_F(InputSynthCommand, MapsOfAnotherSizeAreAnError) {
  DisparityMap small(3, 3);
  small.fill(1);
  write_disparity(left_map_, small.view());
  expect_one_line(synth_from_maps({"-o", outputs_ + "/v.mp4", "--sweep", "0:1:3"}), 1, "synth");
  EXPECT_THAT(files_below(outputs_), IsEmpty());
}

}  // namespace vantage::command_synth_test
