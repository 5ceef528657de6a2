#include <cstring>
#include <regex>
#include <sstream>

#include "engine/image/transposed.h"
#include "engine/matching/options/method_fields.h"
#include "tests/apps/sampling.h"

namespace vantage::match_options_test {

using MatchCommandOptions = PairTest;

using InputMatchOptions = MatchCommandOptions;

TEST_F(InputMatchOptions, BadValuesAreRefusedWithTheirBound) {
  const std::vector<Refusal> refusals = {
      {{"--method", "ssd", "--window", "182"},
       "window is 182, expected an odd number from 1 to 181"},
      {{"--levels", "3", "--candidate-blocks", "2", "--method", "membrane"},
       "candidate-blocks is 2, expected 0 unless aggregation is bayes"},
      {{"--preset", "balanced", "--candidate-blocks", "2", "--disparities-y=-1:1"},
       "candidate-blocks is 2, expected 0 with disparities-y"},
      {{"--search-size", "half"},
       "search-size is not full, expected full: a reduced search-size needs"},
      {{"--preset", "realtime", "--search-size", "half", "--final-iterations", "0"},
       "final-iterations is 0, expected at least 1 with a reduced search-size"},
      {{"--preset", "realtime", "--edge-snapping", "4"},
       "edge-snapping is 4, expected 0 with a reduced search-size"},
      {{"--method", "bayes", "--prior", "quadratic", "--epsilon-prior", "0.1"},
       "epsilon-prior is set but has no effect"},
      {{"--method", "bayes", "--prior", "impulse", "--sigma-prior", "1"},
       "sigma-prior is set but has no effect"},
      {{"--prior", "quadratic", "--candidate-blocks", "2"},
       "candidate-blocks is 2, expected 0 with prior quadratic"},
      {{"--prior", "quadratic", "--window-levels", "1"},
       "window-levels is 1, expected 0; a search in windows"},
      {{"--prior", "quadratic", "--search-size", "half"},
       "search-size is not full, expected full: a reduced search-size needs"},
      {{"--method", "bayes", "--prior", "gaussian"}, "contaminated-gaussian|impulse|quadratic"},
      {{"--method", "ssd", "--prior", "impulse"}, "prior is set but has no effect"},
      {{"--sigma-measurement", "loud"}, "--sigma-measurement is 'loud', expected a number"},
      {{"--disparities", "0:4096"}, "(4097 candidates), expected at most 4096"},
      {{"--disparities-y", "-300:300"}, "expected at most 4096"},
      {{"--disparities", "auto", "--disparities-y", "-3000:3000"}, "expected at most 4096"},
      {{"--disparities", "-3:60", "--output-right", folder_ / "r.png"},
       "r.png is a 16-bit PNG, which holds disparities from 0 to 255.99, but the search range is "
       "-3:60"},
      {{"--disparities", "0:256", "--output-right", folder_ / "r.PNG"},
       "expected .pfm, .tiff, .exr or .npy"},
      {{"--disparities-y", "3"}, "--disparities-y is '3', expected MIN:MAX"},
      {{"--border", "valid", "--aggregate", "gaussian"}, "it is read by the aggregation box"},
      {{"--method", "local-stopping", "--cost", "gradient"}, "expected certainty entropy"},
      {{"--preset", "fast"},
       "--preset is fast, which is no longer there: realtime takes half its time and errs as "
       "little, balanced errs less"},
      {{"--method", "ssd", "--preset", "balanced"}, "method and preset are both set"},
      {{"--disparities-y", "0:1", "--edge-snapping", "on"}, "expected 0 with disparities-y"},
      {{"--cross-check", "never"}, "--cross-check is 'never', expected a number"},
      {{"--fill", "quadratic"},
       "--fill is 'quadratic', expected one of "
       "constant|linear|median|planes|surfaces|canonical|thin-plate|none"},
      {{"--uniform-contrast", "2"},
       "uniform-contrast is set but has no effect with a fill other than canonical and thin-plate"},
      {{"--depth-resolution", folder_ / "z.npy"},
       "--depth-resolution needs --calibration or --focal-length"},
      {{"--disparity-resolution", "1"},
       "--disparity-resolution has no effect without --depth-resolution and --report"},
      {{"--baseline", "2"}, "--baseline has no effect without --focal-length or --calibration"},
      {{"--focal-length", "0"}, "focal-length is 0, expected a number above 0"},
      {{"--focal-length", "9", "--calibration", left_}, "expected one of both"},
      {{"--calibration", left_, "--vertical"}, "expected --focal-length and --baseline"},
      {{"--focal-length", "9", "--depth-resolution", folder_ / "z.png"}, "PNG holds no floats"},
      {{"--unrectified", left_, "--focal-length", "9"}, "depths belong to rectified pixels"},
      {{"--prefilter", "box"}, "--prefilter is 'box', expected one of gaussian|none"},
      {{"--lambda", "0.1"},
       "lambda is set but has no effect with preset balanced (cost census-rays, aggregation bayes, "
       "7 levels); it is read by diffusion, membrane and local-stopping"},
      {{"--raw", "--fill", "none"}, "fill is set but has no effect with raw"},
      {{"--selection", "rows"}, "--selection is 'rows', expected one of winner|scanline|symmetric"},
      {{"--jump-limit", "3"}, "it is read by selection scanline"},
      {{"--selection", "symmetric", "--cross-check", "2"}, "both maps are of one solution"},
      {{"--selection", "symmetric", "--baselines", "1"}, "a symmetric solution is of two images"},
      {{"--baselines", "1", "--window-levels", "0"}, "--window-levels has no effect with several"},
      {{"--tuning", "t.json", "--no-tuning"}, "--tuning has no effect with --no-tuning"},
      {{"--max-disp", "64"}, "'--max-disp': --disparities MIN:MAX is the range to search"},
      {{"--xyzzy"}, "'--xyzzy'; 'vantage match --help-all' lists all"},
      {{"--sigma-pior", "1"}, "'--sigma-pior', the nearest known one is '--sigma-prior'"},
      {{"--agregate", "box"}, "'--agregate', the nearest known one is '--aggregate'"},
      {{"--confidence", folder_ / "c.png"}, "PNG holds no floats"},
      {{"--confidence", folder_ / "c.flo"}, ".pfm .tiff .tif .exr .npy"},
      {{"--disparities-y", "0:1"}, "out.pfm', expected a file name that ends in .flo .tiff"},
      {{"--reference", "right", "--unmatched-right", folder_ / "u.png"},
       "--unmatched-right cannot"},
      {{"--candidate-step", "0.5", "--disparities-y", "0:1"}, "candidate-step is 0.5, expected 1"},
      {{"--baselines", "0"}, "0, expected a finite number other than 0"},
      {{"--baselines", "1,2"}, "--baselines has 2 numbers, expected 1"},
      {{"--baselines", "1,"}, "--baselines is '', expected a number"},
      {{right_, "--baselines", "2,2"}, "are both 2, expected different ones"},
      {{"--baselines", "1", "--output-right", folder_ / "r.pfm"},
       "--output-right cannot be used with"},
      {{"--baselines", "1", "--reference", "right"}, "--reference right cannot be used with"},
      {{"--baselines", "1", "--disparities-y", "0:1"}, "--disparities-y cannot be used with"},
      {{"--vertical", "--disparities-y", "1:0"}, "disparities-y is 1:0, expected MIN:MAX"}};
  expect_refusals("match", folder_.path(), refusals, [&](const Words& words) {
    Words arguments = joined({"match", left_, right_, "-o", folder_ / "out.pfm"}, words);
    if (std::ranges::find(arguments, "--disparities") == arguments.end()) {
      arguments.insert(arguments.end(), {"--disparities", "0:63"});  // nothing is looked for first
    }
    return run_vantage(arguments);
  });
}

TEST_F(InputMatchOptions, ImagesOfUnequalSizeAmongSeveralAreNamed) {
  write_photograph(folder_ / "small.png", {Image<std::uint8_t>(7, 9)});
  const ProcessResult result =
      match(folder_ / "out.pfm", {folder_ / "small.png", "--baselines=1,2"});
  expect_one_line(result, 1, "match", "small.png is 7x9 but ");
  EXPECT_THAT(result.err, HasSubstr("left.png is 71x53, expected equal sizes"));
  // Positions are looked at before images are read.
  EXPECT_EQ(match(folder_ / "out.pfm", {folder_ / "small.png", "--baselines=1,1"}).exit_code, 2);
}

TEST_F(InputMatchOptions, AFileOrAPrintedConfigIsLookedAtLikeTheCommandLine) {
  write_file(folder_ / "job.toml", "method = 'ssd'\nmu = 0.3\n");
  ProcessResult result = match(folder_ / "a.pfm", {"--config", folder_ / "job.toml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("mu is set but has no effect with method ssd"));
  // A printed file names every setting; only what differs from its default is the user's.
  const Words synth = {"synth",           left_,    right_, "-o",
                       folder_ / "v.png", "--view", "0.5",  "--disparities=0:9"};
  write_file(folder_ / "synth.toml", run_vantage(joined(synth, {"--print-config"})).out);
  result = succeeds(run_vantage({"synth", "--config", folder_ / "synth.toml"}));
  for (const auto& [line, says] :
       {std::pair("fps = '30'\n", "--fps has no effect without an output that ends in .mp4"),
        std::pair("gamma = 0.25\nno-intensity-matching = true\n",
                  "--gamma has no effect with --no-intensity-matching")}) {
    write_file(folder_ / "idle.toml", line);
    expect_failure(run_vantage(joined(synth, {"--config", folder_ / "idle.toml"})), 2, says);
  }
}

TEST_F(MatchCommandOptions, EveryFieldOfAMethodHasAnOptionInItsOrder) {
  const std::string config = run_vantage({"match", "--print-config"}).out;
  Words names;
  bool is_of_method = false;
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# Matching: ") || line.starts_with("# Refinement")) {
      is_of_method = line.starts_with("# Matching: ");
    } else if (is_of_method && !line.empty()) {
      names.push_back(line.substr(0, line.find(' ')));
    }
  }
  Words of_fields;
  const MethodOverrides none;
  visit_fields(
      [&](const MethodField& field, const auto&) {
        if (of_fields.empty() || of_fields.back() != field.option) {
          of_fields.emplace_back(field.option);
        }
      },
      none);
  EXPECT_EQ(names, of_fields);
}

TEST_F(MatchCommandOptions, TheFirstLineNamesWhatMapsAreMadeBy) {
  struct Choice {
    Words options;
    std::string says;
    std::string preset;  ///< in the report
  };
  const std::vector<Choice> choices = {
      {{},
       "match: preset balanced (cost census-rays, aggregation bayes, 7 levels), 71x53 pixels",
       "balanced"},
      {{"--preset", "quality"}, "match: preset quality (", "quality"},
      {{"--cost", "census"},
       "match: preset balanced with cost census (cost census, aggregation bayes, 7 levels), ",
       "balanced"},
      {{"--aggregate", "gaussian"},
       "match: method ssd with aggregation gaussian (cost squared, aggregation gaussian, 1 "
       "level), ",
       "none"},
      {{"--method", "membrane"}, "match: method membrane (", "none"}};
  for (const Choice& choice : choices) {
    Words options = joined(choice.options, {"--report", folder_ / "r.json"});
    const ProcessResult result = succeeds(match(folder_ / "map.pfm", options));
    EXPECT_TRUE(result.err.starts_with(choice.says)) << result.err;
    const auto report = read_json(folder_ / "r.json");
    EXPECT_EQ(report["settings"]["resolved"]["preset"], choice.preset);
    options.emplace_back("--quiet");
    EXPECT_EQ(match(folder_ / "map.pfm", options).err, "");
  }
}

TEST_F(MatchCommandOptions, ReportShowsWhatWasSetAndWhatIsInForce) {
  succeeds(match(folder_ / "map.pfm", {"--method", "membrane", "--iterations", "3", "--report",
                                       folder_ / "r.json", "--cross-check", "none"}));
  const auto report = read_json(folder_ / "r.json");
  const auto& settings = report["settings"];
  EXPECT_EQ(settings["method"], "membrane");
  EXPECT_EQ(settings["iterations"], 3);
  EXPECT_EQ(settings["aggregate"], "auto");
  const auto& resolved = settings["resolved"];
  EXPECT_EQ(resolved["aggregate"], "membrane");
  EXPECT_EQ(resolved["cost"], "squared");
  EXPECT_EQ(resolved["iterations"], 3);
  EXPECT_EQ(resolved["levels"], 1);
  EXPECT_EQ(resolved["candidate-blocks"], 0);
  EXPECT_EQ(resolved["pruned-levels"], 2);
  EXPECT_EQ(resolved["beta"], 0.5);
  EXPECT_EQ(resolved["cross-check"], "none");
  EXPECT_EQ(resolved["confidence-threshold"], "none");
  for (const auto& [name, value] : resolved.items()) {
    EXPECT_NE(value, "auto") << name;
  }
  const auto& plan = report["plan"];
  EXPECT_TRUE(plan.contains("stored_bytes"));
  EXPECT_GE(plan["steps"], 1);
  for (const auto& pass : plan["passes"]) {
    for (const char* key : {"first_stage", "end_stage", "strip_width_px", "band_height_px",
                            "work_ratio", "scratch_bytes", "stored_rows"}) {
      EXPECT_TRUE(pass.contains(key)) << key;
    }
  }
}

TEST_F(MatchCommandOptions, ThePresetIsWhatPrintConfigSays) {
  const std::regex meaning("\n([a-z-]+) = 'auto'  # '?([^\n']+)");
  for (const std::string preset : {"realtime", "balanced", "quality"}) {
    const std::string config = run_vantage({"match", "--preset", preset, "--print-config"}).out;
    Words options = {"--method", "bayes"};
    for (std::sregex_iterator it(config.begin(), config.end(), meaning), end; it != end; ++it) {
      options.insert(options.end(), {"--" + (*it)[1].str(), (*it)[2]});
    }
    EXPECT_GT(options.size(), 40U);
    succeeds(match(folder_ / "a.pfm", options));
    succeeds(match(folder_ / "b.pfm", {"--preset", preset}));
    EXPECT_EQ(read_file(folder_ / "a.pfm"), read_file(folder_ / "b.pfm")) << preset;
  }
}

TEST_F(MatchCommandOptions, ConfidenceIsWrittenAndItsThresholdMarks) {
  succeeds(match(folder_ / "a.pfm", {"--method", "bayes", "--confidence", folder_ / "c.npy",
                                     "--unmatched", folder_ / "a.png", "--cross-check", "none"}));
  const DisparityMap confidence = read_disparity(folder_ / "c.npy");
  ASSERT_EQ(confidence.width(), 71);
  succeeds(match(folder_ / "b.pfm", {"--method", "bayes", "--confidence-threshold", "0.99",
                                     "--cross-check", "none", "--unmatched", folder_ / "b.png"}));
  const Photograph all_matched = read_photograph(folder_ / "a.png");
  const Photograph some_matched = read_photograph(folder_ / "b.png");
  int unsure = 0;
  for (int y = 0; y < confidence.height(); ++y) {
    for (int x = 0; x < confidence.width(); ++x) {
      EXPECT_TRUE(confidence.at(x, y) >= 0 && confidence.at(x, y) <= 1) << confidence.at(x, y);
      ASSERT_EQ(std::get<Image<std::uint8_t>>(all_matched.pixels).at(x, y), 0);
      unsure += std::get<Image<std::uint8_t>>(some_matched.pixels).at(x, y) == 255 ? 1 : 0;
    }
  }
  EXPECT_LT(unsure, 71 * 53);
  EXPECT_GT(unsure, 0);
}

TEST_F(MatchCommandOptions, FillNoneLeavesTheUnmatchedUnknown) {
  succeeds(match(folder_ / "a.pfm", {"--fill", "none", "--output-right", folder_ / "r.pfm",
                                     "--unmatched", folder_ / "u.png", "--unmatched-right",
                                     folder_ / "v.png", "--cross-check", "1"}));
  for (const auto& [map_name, mask_name] :
       {std::pair{"a.pfm", "u.png"}, std::pair{"r.pfm", "v.png"}}) {
    const DisparityMap map = read_disparity(folder_ / map_name);
    const Photograph mask = read_photograph(folder_ / mask_name);
    int unmatched = 0;
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        const bool marked = std::get<Image<std::uint8_t>>(mask.pixels).at(x, y) != 0;
        unmatched += marked ? 1 : 0;
        ASSERT_EQ(std::isnan(map.at(x, y)), marked);
      }
    }
    EXPECT_GT(unmatched, 0);
  }
}

/// Columns of a transposed pair are the rows of the pair itself: maps are transposed, and no more.
TEST_F(MatchCommandOptions, CamerasOneAboveTheOtherAreMatchedAlongColumns) {
  write_photograph(folder_ / "upper.png", transposed(read_photograph(left_)));
  write_photograph(folder_ / "lower.png", transposed(read_photograph(right_)));
  const auto match = [&](const std::string& left, const std::string& right, const std::string& name,
                         Words more) {
    succeeds(
        run_vantage(joined({"match", left, right, "-o", folder_ / (name + ".pfm"), "--confidence",
                            folder_ / (name + "-c.pfm"), "--disparities=0:9", "--fill", "none"},
                           more)));
  };
  const auto expect_transposed = [&] {
    for (const std::string kind : {".pfm", "-c.pfm"}) {
      const DisparityMap map = read_disparity(folder_ / ("columns" + kind));
      const DisparityMap rows = read_disparity(folder_ / ("rows" + kind));
      const DisparityMap expected = transposed(rows.view());
      ASSERT_EQ(map.width(), expected.width());
      for (int y = 0; y < map.height(); ++y) {
        ASSERT_EQ(std::memcmp(map.row(y), expected.row(y),
                              sizeof(float) * static_cast<std::size_t>(map.width())),
                  0)
            << kind << ", row " << y;
      }
    }
  };
  const std::string upper = folder_ / "upper.png";
  const std::string lower = folder_ / "lower.png";
  match(left_, right_, "rows", {"--output-right", folder_ / "rows-r.pfm"});
  match(upper, lower, "columns", {"--vertical", "--output-right", folder_ / "columns-r.pfm"});
  expect_transposed();
  EXPECT_EQ(read_disparity(folder_ / "columns-r.pfm").width(), 53);
  match(left_, right_, "rows", {"--baselines", "2"});
  match(upper, lower, "columns", {"--baselines", "2", "--vertical"});
  expect_transposed();
}

TEST_F(MatchCommandOptions, TwoComponentsAreWrittenAsFlow) {
  // The right image one row lower: y_left − y_right = −1.
  const Photograph photograph = read_photograph(right_);
  const auto& right = std::get<Image<std::uint8_t>>(photograph.pixels);
  Image<std::uint8_t> lower(right.width(), right.height());
  for (int y = 0; y < right.height(); ++y) {
    std::copy_n(right.row(std::max(0, y - 1)), right.width(), lower.row(y));
  }
  write_photograph(folder_ / "lower.png", {std::move(lower)});
  succeeds(run_vantage({"match", left_, folder_ / "lower.png", "-o", folder_ / "d.flo",
                        "--disparities=0:9", "--disparities-y=-2:2", "--method", "gradient",
                        "--subpixel", "none"}));
  const std::string bytes = read_file(folder_ / "d.flo");
  ASSERT_EQ(bytes.size(), 12U + 71 * 53 * 8);
  int right_ones = 0;
  int all = 0;
  for (int y = 4; y < 48; ++y) {
    for (int x = 12; x < 66; ++x) {
      float flow[2];
      std::memcpy(flow, bytes.data() + 12 + (y * 71 + x) * 8, 8);
      ++all;
      right_ones +=
          flow[1] == 1 && std::abs(flow[0] + pair_.left_disparity.at(x, y)) < 0.6F ? 1 : 0;
    }
  }
  EXPECT_GT(right_ones, 0.75 * all);
}

TEST_F(MatchCommandOptions, SeveralImagesOfOneCameraAgreeWithThePair) {
  // The right image once more at twice the baseline would need twice the disparities; from the
  // other side of the reference a pair of mirrored baselines is the pair itself.
  succeeds(match(folder_ / "a.pfm", {"--method", "diffusion"}));
  succeeds(match(folder_ / "b.pfm", {"--baselines", "2.5", "--method", "diffusion"}));
  EXPECT_EQ(read_file(folder_ / "a.pfm"), read_file(folder_ / "b.pfm"));
  succeeds(run_vantage({"match", right_, left_, "-o", folder_ / "c.pfm", "--disparities=0:9",
                        "--baselines=-1", "--method", "diffusion"}));
  succeeds(match(folder_ / "d.pfm", {"--reference", "right", "--method", "diffusion"}));
  EXPECT_EQ(read_file(folder_ / "c.pfm"), read_file(folder_ / "d.pfm"));
}

TEST_F(MatchCommandOptions, SeveralImagesWorkWithEveryCostAndPreset) {
  for (const std::string& choice : words("--preset=realtime --preset=balanced --preset=quality "
                                         "--cost=gradient")) {
    succeeds(match(folder_ / "several.pfm",
                   {left_, "--baselines=1,-2.37", choice, "--candidate-step", "0.5"}));
  }
}

TEST_F(MatchCommandOptions, RunAndSynthTakeThem) {
  ProcessResult result =
      succeeds(run_vantage({"synth", left_, right_, "-o", folder_ / "v.png", "--view", "0.5",
                            "--disparities=0:9", "--preset", "balanced", "--edge-snapping", "2"}));
  result = run_vantage({"synth", left_, right_, "-o", folder_ / "w.png", "--view", "0.5",
                        "--disparities=0:9", "--disparities-y", "0:1"});
  expect_failure(result, 2, "--disparities-y");
  for (const char* side : {"l", "r"}) {
    fs::create_directory(folder_ / side);
  }
  fs::copy_file(left_, folder_ / "l/0.png");
  fs::copy_file(right_, folder_ / "r/0.png");
  const Words run = {"run",         "--left", folder_ / "l",   "--right",
                     folder_ / "r", "-o",     folder_ / "out", "--disparities=0:9"};
  const Words arguments = joined(run, {"--method", "gradient", "--save", "disparity,confidence"});
  result = succeeds(run_vantage(arguments));
  EXPECT_TRUE(fs::exists(folder_ / "out/disparity/000000.pfm"));
  succeeds(match(folder_ / "a.pfm", {"--method", "gradient", "--confidence", folder_ / "c.pfm"}));
  EXPECT_EQ(read_file(folder_ / "out/confidence/000000.pfm"), read_file(folder_ / "c.pfm"));
  expect_failure(run_vantage(joined(arguments, {"--format", "png"})), 2,
                 "format is png, which holds no floats");
  EXPECT_EQ(run_vantage(joined(run, {"--disparities-y", "0:1"})).exit_code, 2);
}

}  // namespace vantage::match_options_test
