// Calibrations, pairs and maps that cannot be meant: refused in one line that names the quantity
// and its limit, in every command that takes them, without a file left behind.

#include "tests/apps/pair_fixture.h"

namespace vantage::bad_calibration_test {

/// OpenCV's file of cameras for the fixture's images, entry by entry.
using Entries = std::map<std::string, std::string>;

Entries good_rig() {
  return {{"M1", "[70, 0, 35, 0, 70, 26, 0, 0, 1]"}, {"D1", "[-0.1, 0.01, 0, 0]"},
          {"M2", "[70, 0, 36, 0, 70, 27, 0, 0, 1]"}, {"D2", "[-0.1, 0.02, 0, 0]"},
          {"R", "[1, 0, 0, 0, 1, 0, 0, 0, 1]"},      {"T", "[-1, 0.01, 0.01]"}};
}

std::string yaml_of(const Entries& entries) {
  std::string text = "%YAML:1.0\n---\n";
  for (const auto& [name, value] : entries) {
    text += name + ": " + value + "\n";
  }
  return text;
}

std::string yaml_with(const std::string& name, const std::string& value) {
  Entries entries = good_rig();
  entries[name] = value;
  return yaml_of(entries);
}

std::string yaml_without(const std::string& name) {
  Entries entries = good_rig();
  entries.erase(name);
  return yaml_of(entries);
}

std::string middlebury(const std::string& last_lines) {
  return "cam0=[70 0 30; 0 70 26; 0 0 1]\ncam1=[70 0 33; 0 70 26; 0 0 1]\nndisp=9\n" + last_lines;
}

class InputBadCalibration : public PairTest {
 protected:
  /// One of the commands that take cameras, each in its turn, or all of them, fail with `says`,
  /// which follows the file's name, and leave nothing.
  void expect_refused(const std::string& content, const std::string& says,
                      bool by_all_commands = false) {
    write_file(calibration_, content);
    write_disparity(folder_ / "map.pfm", pair_.left_disparity.view());
    const auto before = files_below(folder_.path());
    std::size_t turn = 0;
    ++refusals_;
    const std::vector<Words> commands = {
        {"rectify", left_, right_, "-o", folder_ / "out", "--matrices", folder_ / "out.yml"},
        {"synth", left_, right_, "-o", folder_ / "out.png", "--view", "0.5", "--disparities=0:9"},
        {"run", "--left", left_, "--right", right_, "-o", folder_ / "out", "--disparities=0:9"},
        {"match", left_, right_, "-o", folder_ / "out.pfm", "--disparities=0:9"},
        {"reproject", folder_ / "map.pfm", "--depth", folder_ / "out.npy", "--baseline", "1"}};
    for (Words arguments : commands) {
      if (turn++ != refusals_ % commands.size() && !by_all_commands) {
        continue;
      }
      const std::string command = arguments.front();
      arguments.insert(arguments.end(), {"--calibration", calibration_});
      expect_one_line(run_vantage(arguments), 1, command, "rig.txt: " + says);
      EXPECT_EQ(files_below(folder_.path()), before) << command << ": " << says;
    }
  }

  std::string calibration_ = folder_ / "rig.txt";
  std::size_t refusals_ = 0;
};

TEST_F(InputBadCalibration, GoodOnesAreTaken) {
  for (const std::string& content :
       {yaml_of(good_rig()), middlebury("doffs=3\nbaseline=100\nwidth=71\nheight=53\n")}) {
    write_file(calibration_, content);
    succeeds(run_vantage({"synth", left_, right_, "-o", folder_ / "out.png", "--view", "0.5",
                          "--disparities=0:9", "--calibration", calibration_}));
  }
}

TEST_F(InputBadCalibration, WhatIsAssumedIsTold) {
  Entries entries = good_rig();
  entries["image_width"] = "142";
  entries["image_height"] = "106";
  entries["M1"] = "[140, 0, 70, 0, 140, 52, 0, 0, 1]";
  entries["M2"] = "[140, 0, 72, 0, 140, 54, 0, 0, 1]";
  write_file(calibration_, yaml_of(entries));
  const Words match = {
      "match",         left_,       right_, "-o", folder_ / "out.pfm", "--disparities=0:9",
      "--calibration", calibration_};
  const std::string scaled = "rig.txt is for images of 142x106 and is scaled to 71x53\n";
  const auto told = run_vantage(match).err;
  EXPECT_THAT(told, HasSubstr(scaled));
  EXPECT_THAT(told, HasSubstr("count as k1 k2 p1 p2; --lens fisheye for those of cv2.fisheye\n"));
  const auto chosen = run_vantage(joined(
      match, {"--lens", "fisheye", "--depth", folder_ / "z.npy", "--calibration-unit", "m"}));
  EXPECT_THAT(chosen.err, Not(HasSubstr("count as")));
  entries["T"] = "[-120, 0, 0]";
  write_file(calibration_, yaml_of(entries));
  EXPECT_THAT(
      run_vantage(joined(match, {"--depth", folder_ / "z.npy", "--calibration-unit", "m"})).err,
      HasSubstr("the baseline is 120 m: is its unit another one? --calibration-unit"));
}

TEST_F(InputBadCalibration, CamerasThatCannotBe) {
  expect_refused(yaml_with("D1", "\n   rows: 4\n   cols: 1\n   data: [0.1, 0, 0, 0]"),
                 "D1 is 4x1 and no key says of which lens, expected --lens fisheye",
                 /*by_all_commands=*/true);
  expect_refused(yaml_with("M1", "[0, 0, 35, 0, 70, 26, 0, 0, 1]"), "the left camera's fx is 0");
  expect_refused(yaml_with("M2", "[70, 0, 36, 0, -70, 27, 0, 0, 1]"),
                 "the right camera's fy is -70, expected a focal length of 0.001 to 1e7 pixels");
  expect_refused(yaml_with("M1", "[70, 0, 35, 0, 70, 26, 0, 0, 0]"),
                 "the left camera's matrix is not of the form");
  expect_refused(yaml_with("M1", "[.nan, 0, 35, 0, 70, 26, 0, 0, 1]"), "M1 holds '.nan'");
  expect_refused(yaml_with("D2", "[inf, 0, 0, 0]"), "D2 holds 'inf', expected finite numbers");
  expect_refused(yaml_with("D1", "[0.1, 0, 0, 0, 0, 0]"),
                 "the left camera has 6 distortion coefficients, expected 0, 4, 5, 8, 12 or 14");
  expect_refused(yaml_with("distortion_model", "omni"),
                 "distortion_model is the lens model omni, which is not supported");
  expect_refused(yaml_without("M2"), "there is no matrix of the right camera: it has D1");
  expect_refused(yaml_without("T"), "it has no R and T");
}

TEST_F(InputBadCalibration, CamerasThatCannotStandSo) {
  expect_refused(yaml_with("R", "[1, 0, 0, 0, 1, 0, 0, 0, -1]"),
                 "R is mirrored: its determinant is -1, expected 1", /*by_all_commands=*/true);
  expect_refused(yaml_with("R", "[2, 0, 0, 0, 2, 0, 0, 0, 2]"), "R is not a rotation");
  expect_refused(yaml_with("R", "[0, 0, 0, 0, 0, 0, 0, 0, 0]"), "R is not a rotation");
  expect_refused(yaml_with("T", "[0, 0, 0]"),
                 "the baseline (length of T) is 0, expected 1e-9 to 1e9");
  expect_refused(yaml_with("T", "[0, 0, -1]"),
                 "the baseline is turned 90.0 degrees from the cameras' x axes, limit 45");
  expect_refused(yaml_with("T", "[1, 0, 0]"), "the right camera is to the left of the left one");
  expect_refused(yaml_with("R", "[-1, 0, 0, 0, 1, 0, 0, 0, -1]"),
                 "the cameras' viewing directions are 180.0 degrees apart, limit 90");
  expect_refused(yaml_with("D1", "[-100, 0, 0, 0]"), "the cameras' common view is");
}

TEST_F(InputBadCalibration, ThoseOfOtherImages) {
  Entries entries = good_rig();
  entries["image_width"] = "142";
  entries["image_height"] = "100";
  expect_refused(yaml_of(entries), "the images are 71x53, but the calibration is for 142x100",
                 /*by_all_commands=*/true);
  expect_refused(yaml_with("M1", "[70, 0, 71, 0, 70, 26, 0, 0, 1]"),
                 "the left camera's principal point (71, 26) is outside of the 71x53 images");
  // In units of the image's width, as some programs write it.
  expect_refused(yaml_with("M1", "[1, 0, 0.5, 0, 1, 0.5, 0, 0, 1]"),
                 "the left camera's fx is 1 pixels, expected at least 3.55 for 71x53 images");
  expect_refused(middlebury("doffs=3\nbaseline=100\nwidth=72\nheight=53\n"),
                 "the images are 71x53, but the calibration is for 72x53");
}

TEST_F(InputBadCalibration, RectifiedOnesThatAreNot) {
  expect_refused(middlebury("doffs=0\nbaseline=100\nwidth=71\nheight=53\n"),
                 "doffs is 0, but cx of cam1 is 3 more than of cam0");
  expect_refused(middlebury("doffs=3\nbaseline=0\nwidth=71\nheight=53\n"),
                 "the baseline (length of T) is 0");
  expect_refused(middlebury("doffs=3\nwidth=71\nheight=53\n"),
                 "there is no baseline in it, expected a number");
  const std::string first = "P0: 70 0 35 0 0 70 26 0 0 0 1 0\n";
  expect_refused(first, "there is no P1 in it, expected a 3x4 matrix");
  expect_refused(first + "P1: 70 0 35 -70 0 70 26 14 0 0 1 0\n",
                 "the cameras are said to be rectified, but 19.6 % of the baseline");
  expect_refused(first + "P1: 70 0 35 70 0 70 26 0 0 0 1 0\n",
                 "the right camera is to the left of the left one");
}

TEST_F(InputBadCalibration, MapsOfAnotherSizeOrSign) {
  // A slanted plane: d grows by a fifth of a pixel per column of the left image.
  const auto write_map = [&](const std::string& name, const auto& disparity_of) {
    DisparityMap map(71, 53);
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        map.at(x, y) = static_cast<float>(disparity_of(x));
      }
    }
    write_disparity(folder_ / name, map.view());
    return folder_ / name;
  };
  const auto in_left = [](double x) { return 10 + x / 5; };
  const auto in_right = [&](double x) { return in_left((x + 10) / 0.8); };
  const std::string left_map = write_map("left.pfm", in_left);
  const std::string right_map = write_map("right.pfm", in_right);
  const auto synth = [&](const std::string& first, const std::string& second) {
    return run_vantage({"synth", left_, right_, "-o", folder_ / "out.png", "--view", "0.5",
                        "--left-disparity", first, "--right-disparity", second,
                        "--no-rectification-check"});
  };
  succeeds(synth(left_map, right_map));
  fs::remove(folder_ / "out.png");

  const std::string negated_left =
      write_map("negated-left.pfm", [&](double x) { return -in_left(x); });
  const std::string negated_right =
      write_map("negated-right.pfm", [&](double x) { return -in_right(x); });
  const std::string small = folder_ / "small.pfm";
  DisparityMap other(70, 53);
  other.fill(2);
  write_disparity(small, other.view());

  const auto before = files_below(folder_.path());
  for (const auto& [first, second, says] :
       {std::tuple{right_map, left_map, "with the maps exchanged: expected x_left - x_right"},
        {negated_left, negated_right, "with the other sign: expected x_left - x_right in both"},
        {small, right_map, "70×53, expected 71×53"},
        {left_map, small, "70×53, expected 71×53"}}) {
    expect_one_line(synth(first, second), 1, "synth", says);
    EXPECT_EQ(files_below(folder_.path()), before);
  }
}

// Cameras that look away are refused; those that look beside the scene, or stand in it, are not
// known to before the view is made.
TEST_F(InputBadCalibration, ViewsThatSeeNothingAreWarnedOf) {
  write_file(calibration_, middlebury("doffs=3\nbaseline=1\nwidth=71\nheight=53\n"));
  const auto synth = [&](const std::string& pose) {
    write_file(folder_ / "pose.toml", pose);
    return run_vantage({"synth", left_, right_, "-o", folder_ / "out.png", "--pose",
                        folder_ / "pose.toml", "--disparities=0:9", "--calibration", calibration_,
                        "--no-rectification-check"});
  };
  const std::string camera = "[[view]]\nK = [[70, 0, 35], [0, 70, 26], [0, 0, 1]]\n";
  const std::string turned = "R = [[0, 0, -1], [0, 1, 0], [1, 0, 0]]\n";  // looks to the right
  const std::string straight = "R = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n";

  const ProcessResult seen = succeeds(synth(camera + straight + "t = [-0.5, 0, 0]\n"));
  EXPECT_THAT(seen.err, Not(HasSubstr("warning")));

  const ProcessResult beside = succeeds(synth(camera + turned + "t = [0, 0, 0]\n"));
  EXPECT_THAT(beside.err,
              HasSubstr("synth: warning: 1 of 1 views show nothing of the scene, the first "
                        "is view 1: "));
  EXPECT_THAT(beside.err, HasSubstr("of it is behind the camera"));

  EXPECT_THAT(synth(camera + straight + "t = [0, 0, 0]\nsize = [0, 9]\n").err,
              HasSubstr("size is 0x9, expected at least 1 pixel each way"));
  expect_failure(synth("[[view]]\nK = [[1e-30, 0, 35], [0, 1e-30, 26], [0, 0, 1]]\n" + straight +
                       "t = [0, 0, 0]\n"),
                 1, "focal lengths are 1e-30 and 1e-30 px, expected 0.001 to 1e+07");
  expect_failure(synth(camera + "R = [[-1, 0, 0], [0, 1, 0], [0, 0, -1]]\nt = [0, 0, -1]\n"), 1,
                 "everything the pair can show is behind it");
}

}  // namespace vantage::bad_calibration_test
