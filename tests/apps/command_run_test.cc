#include "engine/image/stereo_packing.h"
#include "engine/io/video/video_io.h"
#include "tests/apps/sampling.h"

namespace vantage::command_run_test {

/// Names of the files a run made, without those of its journal.
Words made_in(const std::string& folder) {
  Words names;
  for (const auto& [name, content] : results_in(folder)) {
    names.push_back(name);
  }
  return names;
}

/// What a run says that fails: its plan, and an error as the last line.
std::string last_line(const ProcessResult& result) {
  const std::string text = result.err.substr(0, result.err.size() - 1);
  return text.substr(text.rfind('\n') + 1);
}

class RunCommand : public DotFramesTest {
 protected:
  [[nodiscard]] Words arguments(const std::string& out, const Words& more = {}) const {
    return joined({"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9"},
                  more);
  }
  [[nodiscard]] ProcessResult run(const std::string& out, const Words& more = {}) const {
    return run_vantage(arguments(out, more));
  }
};

TEST_F(RunCommand, EveryFrameEqualsTheSingleCommands) {
  const std::string out = folder_ / "out";
  const ProcessResult result =
      succeeds(run(out, {"--save", "disparity,right-disparity,unmatched,preview,views", "--view",
                         "0.5", "--report", folder_ / "r.json"}));
  EXPECT_THAT(result.err, ContainsRegex("6 frames of 47x29 pixels, [0-9.]+ frames/s -> "));
  SCOPED_TRACE(test::sample_name());
  for (const int frame : sampled_range(0, kFrames - 1, 0, 12)) {
    const std::string left = left_ + name(frame);
    const std::string right = right_ + name(frame);
    succeeds(run_vantage({"match", left, right, "--disparities=0:9", "-o", folder_ / "l.pfm",
                          "--output-right", folder_ / "r.pfm", "--unmatched", folder_ / "u.png",
                          "--preview", folder_ / "p.png", "--report", folder_ / "m.json"}));
    succeeds(run_vantage(
        {"synth", left, right, "--disparities=0:9", "-o", folder_ / "v.png", "--view", "0.5"}));
    const auto written = [&](const std::string& kind, const std::string& extension) {
      return read_file(out + "/" + kind + "/00000" + std::to_string(frame) + extension);
    };
    EXPECT_EQ(written("disparity", ".pfm"), read_file(folder_ / "l.pfm")) << frame;
    EXPECT_EQ(written("right-disparity", ".pfm"), read_file(folder_ / "r.pfm")) << frame;
    EXPECT_EQ(written("unmatched", ".png"), read_file(folder_ / "u.png")) << frame;
    EXPECT_EQ(written("preview", ".png"), read_file(folder_ / "p.png")) << frame;
    EXPECT_EQ(written("views", ".png"), read_file(folder_ / "v.png")) << frame;
  }
  EXPECT_EQ(made_in(out).size(), 5U * kFrames);
  const auto report = read_json(folder_ / "r.json");
  EXPECT_EQ(report["command"], "run");
  EXPECT_EQ(report["results"]["frames"], kFrames);
  const auto of_pair = read_json(folder_ / "m.json");
  EXPECT_GE(of_pair["cells"], 47.0 * 29 * 10 * 2);
  EXPECT_EQ(report["cells"], of_pair["cells"].get<double>() * kFrames);
  EXPECT_LE(report["seconds"]["compute"], report["seconds"]["wall"]);
  const auto& costs = report["results"]["processor_seconds_per_frame"];
  for (const char* step : {"read", "decode", "match", "views", "pictures", "encode", "deliver"}) {
    EXPECT_GT(costs[step], 0) << step;
  }
  EXPECT_EQ(costs["rectify"], 0);
  double processor_seconds = 0;
  for (const auto& cost : costs) {
    processor_seconds += cost.get<double>() * kFrames;
  }
  const double wall_and_threads =
      report["seconds"]["wall"].get<double>() * report["threads"].get<double>();
  EXPECT_GT(report["results"]["share_busy"], 0);
  EXPECT_LE(processor_seconds, 1.1 * wall_and_threads);
}

TEST_F(RunCommand, QuietIsQuietInTheSurveyToo) {
  const ProcessResult result = succeeds(
      run(folder_ / "out", words("--save preview --preview-range shot --progress bar --quiet")));
  EXPECT_EQ(result.err, "");
}

TEST_F(RunCommand, TakesPatternsGlobsAndVideos) {
  succeeds(run(folder_ / "a"));
  succeeds(run_vantage({"run", "--left", left_ + "/frame%d.png", "--right", right_ + "/*.png", "-o",
                        folder_ / "b", "--disparities=0:9", "--quiet"}));
  EXPECT_EQ(results_in(folder_ / "a"), results_in(folder_ / "b"));
  for (const std::string side : {"left", "right"}) {
    VideoWriter video(folder_ / (side + ".mp4"), 48, 30, {});
    for (int frame = 0; frame < 3; ++frame) {
      Image<std::uint8_t> grey(48, 30);
      for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 48; ++x) {
          grey.at(x, y) = static_cast<std::uint8_t>(x * 37 + y * 11 + frame);
        }
      }
      video.write({std::move(grey)});
    }
    video.finish();
  }
  succeeds(run_vantage({"run", "--left", folder_ / "left.mp4", "--right", folder_ / "right.mp4",
                        "-o", folder_ / "c", "--disparities=0:9"}));
  EXPECT_THAT(made_in(folder_ / "c"),
              ElementsAre("disparity/000000.pfm", "disparity/000001.pfm", "disparity/000002.pfm"));
}

TEST_F(RunCommand, FramesThatOneCameraDroppedAreLeftOut) {
  const std::string whole = folder_ / "whole";
  succeeds(run(whole));
  fs::remove(left_ + name(1));
  fs::remove(right_ + name(3));
  const std::string out = folder_ / "out";
  const ProcessResult result = succeeds(run(out, {"--report", folder_ / "r.json"}));
  EXPECT_THAT(result.err, HasSubstr("note: 2 frames are left out without a partner (1 of the left, "
                                    "1 of the right): "));
  const auto results = read_json(folder_ / "r.json")["results"];
  EXPECT_EQ(results["paired"]["by"], "name");
  EXPECT_THAT(results["paired"]["frames_left_out"], ElementsAre(1, 1));
  const auto disparity = [&](const std::string& folder, int frame) {
    return read_file(folder + "/disparity/00000" + std::to_string(frame) + ".pfm");
  };
  const int kept[] = {0, 2, 4, 5};
  EXPECT_EQ(made_in(out).size(), std::size(kept));
  for (int pair = 0; pair < 4; ++pair) {
    EXPECT_EQ(disparity(out, pair), disparity(whole, kept[pair])) << pair;
  }
  // Parts, and a run that goes on, have the same pairs; other pairs are another run.
  const std::string parts = folder_ / "parts";
  for (const char* shard : {"2/2", "1/2"}) {
    succeeds(run(parts, {"--shard", shard, "--chunk-frames", "1"}));
  }
  fs::remove(out + "/disparity/000002.pfm");
  succeeds(run(out, {"--resume"}));
  for (int pair = 0; pair < 4; ++pair) {
    EXPECT_EQ(disparity(parts, pair), disparity(whole, kept[pair])) << pair;
  }
  EXPECT_EQ(disparity(out, 2), disparity(whole, 4));
  EXPECT_THAT(last_line(run(out, {"--resume", "--pair-by", "order"})), HasSubstr("pair-by was"));
  succeeds(run(folder_ / "every", {"--every", "2"}));
  EXPECT_EQ(disparity(folder_ / "every", 1), disparity(whole, 4));
}

using InputRunCommand = RunCommand;

TEST_F(InputRunCommand, WrongUsageIsOneLineAndExit2) {
  const std::string out = folder_ / "out";
  const std::vector<Refusal> refusals = {
      {{"--save", "disparity,colour"}, "--save is 'colour'"},
      {{"--save", "views"}, "expected --view XS"},
      {{"--save", "disparity", "--view", "0.5"}, "save has no views"},
      {{"--view", "0.5", "--view", "0.5"}, "given twice"},
      {{"--view", "0.5,1,2"}, "--view is '0.5,1,2', expected a position"},
      {{"--format", "gif"}, "format is 'gif'"},
      {{"--in-flight", "0"}, "in-flight is 0"},
      {{"--reference", "right", "--save", "right-disparity"}, "right-disparity"},
      {{"--shard", "3/2"}, "--shard is '3/2', expected I/N"},
      {{"--shard", "0/2"}, "--shard is '0/2'"},
      {{"--frames", "5-4"}, "--frames is '5-4', expected a range"},
      {{"--frames", "3"}, "--frames is '3'"},
      {{"--memory", "4X"}, "--memory is '4X', expected a size"},
      {{"--memory", "0"}, "--memory is '0'"},
      {{"--video", "disparity"}, "whose values a video cannot hold"},
      {{"--video", "preview"}, "--save …,preview"},
      {{"--view-path", "0"}, "--view-path is '0', expected keys"},
      {{"--stereo-views", "0.5"}, "--stereo-views is '0.5'"},
      {{"--stereo-packing", "sbs"}, "--stereo-packing is 'sbs'"},
      {{"--fps", "0"}, "--fps is '0'"},
      {{"--chunk-frames", "0"}, "chunk-frames is 0"},
      {{"--temporal-prior", "-1"}, "-1"},
      {{"--reuse", "frame", "--method", "ssd"},
       "reuse is frame, expected none with a method without coarse levels"},
      {{"--reuse", "frame", "--candidate-step", "0.5"},
       "reuse is frame, expected none with candidates between"},
      {{"--progress", "loud"}, "--progress is 'loud'"},
      {{"--crf", "20"}, "--crf has no effect without --video"},
      {{"--save", "preview", "--format", "npy"}, "--format has no effect where --save has no"},
      {{"--gamma", "1"}, "--gamma has no effect where --save has no views"},
      {{"--temporal-threshold", "5"}, "--temporal-threshold has no effect without"},
      {{"--stride", "2"}, "'--stride': --every N takes every Nth pair"},
      {{"--step", "2"}, "step"},
      {{"--stereo", "x.mp4"}, "stereo"},
      {{"-p", "2"}, "unknown option '-p'; 'vantage run --help-all' lists all"},
      {{"--overwrite", "--resume"}, "--overwrite and --resume"},
      {{"--overwrite", "--shard", "1/2"}, "--overwrite with --shard"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(out, words); });
  fs::rename(left_, folder_ / "disparity");
  expect_failure(run_vantage({"run", "--left", folder_ / "disparity", "--right", right_, "-o",
                              folder_.path().string(), "--disparities=0:9"}),
                 2, "would write into");
}

TEST_F(InputRunCommand, BadSourcesAreOneLineAndExit1) {
  fs::create_directory(folder_ / "empty");
  for (const std::string& source :
       {folder_ / "none", folder_ / "empty", folder_ / "none/%03d.png", folder_ / "none/*.png"}) {
    expect_one_line(run_vantage({"run", "--left", left_, "--right", source, "-o", folder_ / "out"}),
                    1, "run");
  }
  write_file(folder_ / "file", "not a folder");
  const ProcessResult result = run(folder_ / "file");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(last_line(result), HasSubstr(folder_ / "file"));
}

TEST_F(InputRunCommand, EveryKindOfInputGivesTheSame) {
  const Words outputs = words("--save disparity,views --view 0.5 --quiet --disparities=0:9 -o");
  const auto made_from = [&](const Words& input, const std::string& out) {
    succeeds(run_vantage(joined(joined({"run"}, input), joined(outputs, {folder_ / out}))));
    return results_in(folder_ / out);
  };
  const auto expected = made_from({"--left", left_, "--right", right_}, "two");
  ASSERT_EQ(expected.size(), 2U * kFrames);
  // A list, with names relative to it.
  std::string list = "left,right\n# frames\n\n";
  // One picture for both, and one camera that stands where the left and the right one did in turn.
  fs::create_directories(folder_ / "packed");
  fs::create_directories(folder_ / "walk");
  for (int frame = 0; frame < kFrames; ++frame) {
    list += "left" + name(frame) + ",\"right" + name(frame) + "\"\n";
    const Photograph left = read_photograph(left_ + name(frame));
    const Photograph right = read_photograph(right_ + name(frame));
    Photograph packed;
    pack_stereo(left, right,
                {.layout = StereoLayout::kAboveBelow, .half_size = false, .right_first = true},
                packed);
    write_photograph(folder_ / "packed" + name(frame), packed);
    write_photograph(folder_ / "walk" + name(2 * frame), left);
    write_photograph(folder_ / "walk" + name(2 * frame + 1), right);
  }
  write_file(folder_ / "pairs.csv", list);
  EXPECT_EQ(made_from({"--pairs", folder_ / "pairs.csv"}, "list"), expected);
  EXPECT_EQ(made_from({"--stereo", folder_ / "packed", "--packing", "abr"}, "packed-out"),
            expected);
  succeeds(run_vantage({"merge", folder_ / "packed-out"}));
  auto walked = made_from({"--sequence", folder_ / "walk", "--step", "1"}, "walk-out");
  ASSERT_EQ(walked.size(), 2U * (2 * kFrames - 1));
  EXPECT_EQ(walked["disparity/000004.pfm"], expected.at("disparity/000002.pfm"));
  // Shifted against each other, and back.
  fs::create_directories(folder_ / "late");
  for (int frame = 0; frame < kFrames; ++frame) {
    fs::copy_file(right_ + name(frame), folder_ / "late" + name(frame + 3));
  }
  write_photograph(folder_ / "late" + name(2), {Image<std::uint8_t>(47, 29)});
  EXPECT_EQ(made_from({"--left", left_, "--right", folder_ / "late", "--offset", "1"}, "late-out"),
            expected);
}

TEST_F(RunCommand, VideosHoldWhatTheImagesShow) {
  const Words outputs = {
      "--save",    "preview,views,stereo", "--view-path", "0=0,5=1",        "--stereo-views",
      "0.25,0.75", "--stereo-packing",     "sbsl",        "--chunk-frames", "4"};
  const Words videos =
      joined(outputs, {"--video", "preview,views,stereo", "--crf", "4", "--fps", "30000/1001"});
  succeeds(run(folder_ / "images", outputs));
  succeeds(run(folder_ / "videos", videos));
  EXPECT_THAT(made_in(folder_ / "videos"), ElementsAre("preview.mp4", "stereo.mp4", "views.mp4"));
  for (const std::string kind : {"preview", "views", "stereo"}) {
    VideoReader video(folder_ / "videos/" + kind + ".mp4");
    EXPECT_EQ(video.frame_count(), kFrames);
    EXPECT_EQ(video.frame_rate(), (FrameRate{30000, 1001}));
    const Photograph image = read_photograph(folder_ / "images/" + kind + "/000003.png");
    // H.264 has even sizes.
    EXPECT_EQ(video.width(), (image.width() + 1) / 2 * 2) << kind;
    EXPECT_EQ(video.height(), (image.height() + 1) / 2 * 2) << kind;
  }
}

TEST_F(RunCommand, ADryRunForecastsTheRun) {
  const std::string report = folder_ / "report.json";
  const std::size_t before = folder_.entries();
  const Words outputs = {"--frames", "1-5", "--save", "disparity,views", "--view", "0.5"};
  const ProcessResult result =
      succeeds(run(folder_ / "out", joined(outputs, {"--dry-run", "--report", report})));
  EXPECT_THAT(result.out, AllOf(HasSubstr(" frames/s and "), HasSubstr("like the first 5")));
  EXPECT_EQ(folder_.entries(), before + 1);
  const nlohmann::json kept = read_json(report).at("results");
  EXPECT_EQ(kept.at("forecast").at("frames_timed"), 5);
  const double frames_per_s = kept.at("forecast").at("frames_per_second");
  EXPECT_GT(frames_per_s, 0);
  EXPECT_GT(kept.at("forecast").at("seconds"), 5 / frames_per_s);
  // The steps are those of the run.
  succeeds(run(folder_ / "out", joined(outputs, {"--report", report})));
  const nlohmann::json made = read_json(report).at("results").at("processor_seconds_per_frame");
  for (const auto& [step, seconds] : made.items()) {
    EXPECT_EQ(seconds > 0, kept.at("processor_seconds_per_frame").at(step) > 0) << step;
  }
}

TEST_F(RunCommand, ADryRunTellsThePlanAndWritesNothing) {
  const ProcessResult result = succeeds(run(
      folder_ / "out", {"--dry-run", "--memory", "900M", "--frames", "2-3", "--in-flight", "3"}));
  EXPECT_EQ(result.err, "");
  for (const char* part : {"6 pairs of 47x29", "frames 2-3", "disparities 0:9",
                           "3 frames in flight", "of 900 MiB", "writes disparity to"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  expect_one_line(run(folder_ / "out", {"--dry-run", "--memory", "1M"}), 1, "run",
                  "memory is 1 MiB, expected at least");
  expect_failure(run(folder_ / "out", {"--frames", "6-9"}), 1,
                 "--frames starts at 6 but the input has 6 frames");
  const ProcessResult partly = succeeds(run(folder_ / "partly", {"--frames", "4-9", "--dry-run"}));
  EXPECT_THAT(partly.err, HasSubstr("run: warning: --frames 4-9 ends after the input, which has 6 "
                                    "frames (0 to 5)\n"));
  const ProcessResult every =
      run(folder_ / "every", {"--frames", "0-5", "--every", "4", "--dry-run"});
  EXPECT_THAT(every.err, Not(HasSubstr("warning: --frames")));
}

TEST_F(InputRunCommand, JobFilesHoldEverything) {
  const Words more = words(
      "--save preview,views,stereo --view 0.25 --view-path 0=0,5=1 --video stereo --fps "
      "12.5 --frames 1-4 --iterations 2 --memory 2G --keep-going --no-sound");
  const ProcessResult config = succeeds(run(folder_ / "job", joined(more, {"--print-config"})));
  write_file(folder_ / "job.toml", config.out);
  const ProcessResult again = run_vantage({"run", folder_ / "job.toml", "--print-config"});
  EXPECT_EQ(again.out, config.out);
  const ProcessResult options = succeeds(run(folder_ / "options", more));
  const ProcessResult job = succeeds(run_vantage({"run", folder_ / "job.toml"}));
  EXPECT_EQ(results_in(folder_ / "job"), results_in(folder_ / "options"));
  write_file(folder_ / "typo.toml", "keep-goin = true\n");
  expect_failure(run_vantage({"run", folder_ / "typo.toml"}), 2,
                 "unknown key 'keep-goin', the nearest known one is 'keep-going'");
  EXPECT_EQ(run_vantage({"run", folder_ / "job.toml", "--config", folder_ / "job.toml"}).exit_code,
            2);
}

TEST_F(RunCommand, EveryNthFrame) {
  succeeds(run(folder_ / "all"));
  const FolderContent all = results_in(folder_ / "all");
  const auto of_frames = [&](const std::vector<int>& frames) {
    FolderContent content;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      content["disparity/" + frame_file(static_cast<int>(i), "pfm")] =
          all.at("disparity/" + frame_file(frames[i], "pfm"));
    }
    return content;
  };
  succeeds(run(folder_ / "every", {"--every", "2"}));
  EXPECT_EQ(results_in(folder_ / "every"), of_frames({0, 2, 4}));
  succeeds(run(folder_ / "step", {"--frames", "1-4:3"}));
  EXPECT_EQ(results_in(folder_ / "step"), of_frames({1, 4}));
  // Parts count the frames of the input, and a part is continued by its folder alone.
  const std::string parts = folder_ / "parts";
  succeeds(run(parts, {"--every", "2", "--frames", "3-5"}));
  EXPECT_EQ(journalled_frames(parts), (std::vector<int>{2}));
  succeeds(run(parts, {"--every", "2", "--frames", "0-2"}));
  EXPECT_EQ(results_in(parts), of_frames({0, 2, 4}));
  fs::remove(folder_ / "step/disparity/000001.pfm");
  succeeds(run_vantage({"run", "-o", folder_ / "step", "--resume"}));
  EXPECT_EQ(results_in(folder_ / "step"), of_frames({1, 4}));
  EXPECT_THAT(run(parts, {"--resume"}).err, HasSubstr("every was"));
  const std::vector<Refusal> refusals = {
      {{"--every", "0"}, "every is 0, expected 1 to"},
      {{"--every", "2x"}, "--every is '2x', expected a number of frames"},
      {{"--every", "4s"}, "every is 4s, but images have no frame rate"},
      {{"--every", "0s"}, "every is 0s, expected 0.001"},
      {{"--frames", "0-5:0"}, "--frames is '0-5:0', expected a range"},
      {{"--frames", "0-5:2", "--every", "3"}, "expected one of the two"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(folder_ / "wrong", words); });
  EXPECT_THAT(run(folder_ / "wrong", {"--every", "3", "--frames", "1-2"}).err,
              HasSubstr("--frames 1-2 has none of the 2 frames that --every 3 takes"));
}

TEST_F(RunCommand, MergeChecksAndJoinsWhatPartsHaveMade) {
  const Words outputs = words("--save disparity,preview --video preview --chunk-frames 2");
  succeeds(run(folder_ / "whole", outputs));
  const std::string out = folder_ / "parts";
  const auto part = [&](const Words& more) { return run(out, joined(outputs, more)).exit_code; };
  EXPECT_EQ(run_vantage({"merge", out}).exit_code, 1);
  ASSERT_EQ(part({"--shard", "3/3"}), 0);
  ASSERT_EQ(part({"--shard", "1/3"}), 0);
  expect_one_line(run_vantage({"merge", out}), 1, "merge", "2 of 6 frames are missing (2-3)");
  EXPECT_EQ(run_vantage({"merge", out, "--partial"}).exit_code, 1);
  EXPECT_FALSE(fs::exists(out + "/preview.mp4"));
  ASSERT_EQ(part({"--frames", "2-3"}), 0);
  const ProcessResult complete =
      succeeds(run_vantage({"merge", out, "--report", folder_ / "m.json"}));
  EXPECT_THAT(complete.err, HasSubstr("parts holds all 6 frames\n"));
  EXPECT_EQ(results_in(out), results_in(folder_ / "whole"));
  EXPECT_EQ(read_json(folder_ / "m.json")["results"]["frames"], 6);
  succeeds(run_vantage({"merge", out}));
  EXPECT_EQ(results_in(out), results_in(folder_ / "whole"));
  fs::remove(out + "/disparity/000004.pfm");
  EXPECT_THAT(run_vantage({"merge", out}).err, HasSubstr("1 of 6 frames are missing (4)"));
}

}  // namespace vantage::command_run_test
