#include "engine/matching/stereo_matcher.h"
#include "tests/apps/sampling.h"

namespace vantage::command_match_test {

using MatchCommand = PairTest;

TEST_F(MatchCommand, FindsTheTruth) {
  const ProcessResult result = succeeds(match(folder_ / "map.pfm", {}));
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("71x53"));
  EXPECT_LT(
      bad_share(read_disparity(folder_ / "map.pfm"), pair_.left_disparity, pair_.left_occluded),
      0.05);
}

TEST_F(MatchCommand, NamesItsFilesAndTheColoursOfThePreview) {
  const std::string map = folder_ / "map.pfm";
  const std::string mask = folder_ / "mask.png";
  const std::string preview = folder_ / "view.png";
  const ProcessResult result = match(map, {"--unmatched", mask, "--preview", preview});
  EXPECT_THAT(result.err, HasSubstr(left_ + " -> " + map + ", " + mask + ", " + preview + "\n"));
  EXPECT_THAT(result.err,
              HasSubstr(preview + ": blue is 0 px (far), red 9 px (near), black unknown\n"));
}

TEST_F(MatchCommand, WritesEverythingAskedFor) {
  const ProcessResult result =
      succeeds(match(folder_ / "l.pfm", {"--output-right", folder_ / "r.npy", "--unmatched",
                                         folder_ / "mask.png", "--preview", folder_ / "view.jpg",
                                         "--report", folder_ / "report.json", "--quiet"}));
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(files_below(folder_.path()), ElementsAre("l.pfm", "left.png", "mask.png", "r.npy",
                                                       "report.json", "right.png", "view.jpg"));
  EXPECT_LT(
      bad_share(read_disparity(folder_ / "r.npy"), pair_.right_disparity, pair_.right_occluded),
      0.1);
  const Photograph preview = read_photograph(folder_ / "view.jpg");
  EXPECT_EQ(preview.channels(), 3);
  EXPECT_EQ(preview.width(), 71);
  const Photograph mask = read_photograph(folder_ / "mask.png");
  EXPECT_EQ(mask.channels(), 1);
}

TEST_F(MatchCommand, WritesAndReportsDepthResolution) {
  succeeds(
      match(folder_ / "map.pfm", {"--method", "ssd", "--subpixel", "none", "--focal-length", "500",
                                  "--baseline", "0.1", "--depth-resolution", folder_ / "z.npy",
                                  "--report", folder_ / "report.json", "--fill", "canonical"}));
  const DisparityMap map = read_disparity(folder_ / "map.pfm");
  const DisparityMap resolution = read_disparity(folder_ / "z.npy");
  float nearest = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const float d = map.at(x, y);
      nearest = std::max(nearest, d);
      if (d > 1) {
        EXPECT_FLOAT_EQ(resolution.at(x, y), 50 / (d - 1) - 50 / d);
      } else {
        EXPECT_TRUE(std::isnan(resolution.at(x, y)));
      }
    }
  }
  const auto report = read_json(folder_ / "report.json");
  const auto& values = report["results"]["depth_resolution"];
  EXPECT_EQ(values["disparity_resolution_px"], 1);
  EXPECT_FLOAT_EQ(values["nearest"]["depth"].get<float>(), 50 / nearest);
  EXPECT_FLOAT_EQ(values["nearest"]["relative_resolution"].get<float>(), 1 / (nearest - 1));
}

TEST_F(MatchCommand, EqualsTheLibrary) {
  succeeds(
      match(folder_ / "map.pfm", {"--method", "ssd", "--window=3", "--raw", "--border", "valid"}));
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = {0, 9};
  options.parameters.window_px = 3;
  options.raw = true;
  options.parameters.border = Border::kValid;
  Execution execution({});
  DisparityMaps maps;
  StereoMatcher(options, execution).match(pair_.left, pair_.right, {true, false}, maps);
  const DisparityMap map = read_disparity(folder_ / "map.pfm");
  int unknown = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const float expected = maps.left.disparity_px.at(x, y);
      unknown += std::isnan(expected) ? 1 : 0;
      EXPECT_TRUE(map.at(x, y) == expected || (std::isnan(map.at(x, y)) && std::isnan(expected)));
    }
  }
  EXPECT_GT(unknown, 0);  // the frame that border valid leaves
}

TEST_F(MatchCommand, ReferenceRightWritesTheRightMap) {
  succeeds(match(folder_ / "a.pfm", {"--output-right", folder_ / "b.pfm"}));
  succeeds(match(folder_ / "c.pfm", {"--reference", "right"}));
  EXPECT_EQ(read_file(folder_ / "b.pfm"), read_file(folder_ / "c.pfm"));
  EXPECT_NE(read_file(folder_ / "a.pfm"), read_file(folder_ / "c.pfm"));
}

TEST_F(MatchCommand, SignedRangesInBothSpellings) {
  // With the images swapped every disparity changes its sign.
  const Words swapped = {"match", right_, left_, "-o"};
  succeeds(run_vantage(joined(swapped, {folder_ / "joined.pfm", "--disparities=-9:0"})));
  succeeds(run_vantage(joined(swapped, {folder_ / "apart.pfm", "--disparities", "-9:0"})));
  EXPECT_EQ(read_file(folder_ / "joined.pfm"), read_file(folder_ / "apart.pfm"));
  const DisparityMap map = read_disparity(folder_ / "apart.pfm");
  DisparityMap negated = pair_.right_disparity.copy();
  for (int y = 0; y < negated.height(); ++y) {
    for (int x = 0; x < negated.width(); ++x) {
      negated.at(x, y) = -negated.at(x, y);
    }
  }
  EXPECT_LT(bad_share(map, negated, pair_.right_occluded), 0.1);
}

TEST_F(MatchCommand, ReportHasTheKeysOfTheContract) {
  succeeds(match(folder_ / "map.pfm",
                 {"--method", "ssd", "--report", folder_ / "r.json", "--threads", "2"}));
  const auto report = nlohmann::ordered_json::parse(read_file(folder_ / "r.json"));
  Words keys;
  for (const auto& [key, value] : report.items()) {
    keys.push_back(key);
  }
  EXPECT_THAT(keys,
              ElementsAre("command", "version", "settings", "plan", "isa", "threads", "seconds",
                          "cells", "cells_per_second", "peak_memory_bytes", "warnings", "notes",
                          "candidates_per_pixel", "binding", "memory", "tuning", "results"));
  EXPECT_EQ(report["command"], "match");
  EXPECT_EQ(report["settings"]["disparities"], "0:9");
  EXPECT_EQ(report["threads"], 2);
  EXPECT_EQ(report["cells"], 71.0 * 53 * 10 * 2);
  EXPECT_EQ(report["candidates_per_pixel"], 10);
  EXPECT_GT(report["peak_memory_bytes"], 1 << 20);
  const auto& owners = report["memory"]["owners"];
  EXPECT_GE(owners["photographs"], 2 * 71 * 53);
  EXPECT_GE(owners["maps"], 2 * 71 * 53 * 4);
  EXPECT_GT(owners["program"], 1 << 20);
  EXPECT_GE(report["plan"]["passes"].size(), 1U);
  const auto& seconds = report["seconds"];
  EXPECT_TRUE(seconds["stages"].contains("read"));
  EXPECT_TRUE(seconds["stages"].contains("write"));
  EXPECT_GT(seconds["compute"], 0);
  EXPECT_GE(seconds["wall"].get<double>(),
            seconds["compute"].get<double>() + seconds["stages"]["read"].get<double>());
}

TEST_F(MatchCommand, IsaIsTheOneThatRan) {
  const auto info = nlohmann::json::parse(run_vantage({"info", "--json"}).out);
  for (const std::string name : info["isa_available"]) {
    succeeds(match(folder_ / "a.pfm", {"--isa", name, "--report", folder_ / "r.json"}));
    EXPECT_EQ(read_json(folder_ / "r.json")["isa"], name);
  }
}

using InputMatchCommand = MatchCommand;

TEST_F(InputMatchCommand, WrongUsageIsOneLineAndExit2) {
  const std::string out = folder_ / "out.pfm";
  const std::vector<Refusal> refusals = {
      {{}, "--output"},
      {{"-o", out, "--window", "8"}, "window is 8"},
      {{"-o", out, "--window", "wide"}, "--window is 'wide', expected a whole number"},
      {{"-o", out, "--window", "3", "--window", "5"}, "--window is given 2 times"},
      {{"-o", out, "--disparities", "9"}, "--disparities is '9', expected MIN:MAX"},
      {{"-o", out, "--disparities", "9:1"}, "9:1"},
      {{"-o", out, "--method", "magic"}, "--method is 'magic', expected one of ssd"},
      {{"-o", out, "--isa", "Z80"}, "isa is 'Z80'"},
      {{"-o", out, "--threads", "0"}, "threads is 0"},
      {{"-o", out, "--iterations-per-pass", "0"}, "iterations-per-pass is 0, expected at least 1"},
      {{"-o", out, "--windw=5"}, "'--windw', the nearest known one is '--window'"},
      {{"-o", out, "-7"}, "unknown option '-7'"},
      {{"-o", out, "third.png"}, "--baselines has 0 numbers, expected 2"},
      {{"-o", folder_ / "out.xyz"}, "out.xyz"},
      {{"-o", left_}, "which is also an input"},
      {{"-o", folder_ / "../" + folder_.path().filename().string() + "/left.png"},
       "which is also an input"},
      {{"-o", out, "--output-right", out}, "the same file"},
      {{"-o", out, "--reference", "right", "--output-right", folder_ / "r.pfm"}, "--output-right"},
      {{"-o", out, "--window"}, "--window"}};
  expect_refusals("match", folder_.path(), refusals, [&](const Words& words) {
    return run_vantage(joined({"match", left_, right_}, words));
  });
}

TEST(InputCommandLine, WordsOfOtherProgramsAreAnsweredWithWhatThereIs) {
  const auto answer = [](const Words& arguments) {
    const ProcessResult result = run_vantage(arguments);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(answer({"run", "--stride", "2"}), HasSubstr("--every N takes every Nth pair"));
  EXPECT_THAT(answer({"run", "--depth", "z.png"}), HasSubstr("--save depth,cloud,mesh writes"));
  EXPECT_THAT(answer({"match", "--point-cloud", "c.ply"}), HasSubstr("--cloud FILE.ply points"));
  EXPECT_THAT(answer({"synth", "--depth", "z.png"}), HasSubstr("'vantage match --depth FILE'"));
  EXPECT_THAT(answer({"pointcloud"}), HasSubstr("'vantage reproject' those of a disparity map"));
}

TEST(InputCommandLine, UnknownCommandsAndHelp) {
  ProcessResult result = run_vantage({"mach"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "vantage: unknown command 'mach', the nearest known one is 'match'\n");
  expect_failure(run_vantage({"scene"}), 2, "'vantage scene build' or 'vantage scene view'");
  // Names of before say what they are now.
  EXPECT_THAT(run_vantage({"experiment", "6.16"}).err, HasSubstr("now 'vantage book figure'"));
  EXPECT_THAT(run_vantage({"response", "a.png"}).err, HasSubstr("'vantage book figure 5.4 5.5'"));
  EXPECT_THAT(run_vantage({"generate", "book"}).err, HasSubstr("now 'vantage book pair'"));
  // What is not near is not suggested; what users of other programs mean is answered.
  EXPECT_EQ(run_vantage({"foo"}).err, "vantage: unknown command 'foo'; 'vantage help' lists all\n");
  EXPECT_EQ(run_vantage({"disparity"}).err,
            "vantage: unknown command 'disparity': 'vantage match' computes disparity maps\n");
  EXPECT_EQ(run_vantage({"help"}).out, run_vantage({"--help"}).out);
  EXPECT_EQ(run_vantage({"help", "match"}).out, run_vantage({"match", "--help"}).out);
  EXPECT_EQ(run_vantage({"help", "scene view"}).out, run_vantage({"help", "scene", "view"}).out);
  EXPECT_EQ(run_vantage({"help", "scene", "view"}).out,
            run_vantage({"scene", "view", "--help"}).out);
  EXPECT_EQ(run_vantage({}).exit_code, 2);
  result = succeeds(run_vantage({"--help"}));
  // What pairs and films need stands first, the book last.
  EXPECT_THAT(result.out,
              ContainsRegex("Stereo pairs\n  check.*\n  match.*\nSequences and films\n  run.*\n"
                            "Scharstein's book\n  book figure [^:]*\n\nInputs are files"));
  result = succeeds(run_vantage({"match", "--help"}));
  EXPECT_THAT(result.out, HasSubstr("--disparities MIN:MAX"));
  EXPECT_EQ(result.out.find("--trace FILE"), std::string::npos);
  EXPECT_THAT(run_vantage({"help", "match", "--help-all"}).out, HasSubstr("--trace FILE"));
  // What `auto` is without a method, too.
  EXPECT_THAT(run_vantage({"match", "--help-json"}).out,
              HasSubstr("on: 10; auto: 0; 10 with preset balanced"));
  EXPECT_EQ(run_vantage({"--version"}).out.rfind("vantage ", 0), 0U);
  EXPECT_THAT(run_vantage({"--version", "--verbose"}).out,
              AllOf(HasSubstr("FFmpeg"), HasSubstr("processor"), HasSubstr("instruction sets")));
  expect_failure(run_vantage({"--version", "--all"}), 2,
                 "'--all' after --version, expected nothing or --verbose");
}

}  // namespace vantage::command_match_test
