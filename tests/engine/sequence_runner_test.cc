#include "engine/sequence/sequence_runner.h"

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/io/video/video_io.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/sequence_join.h"
#include "engine/sequence/steps/busy_clock.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/made_up_pairs.h"

namespace vantage::sequence_runner_test {

namespace fs = std::filesystem;

struct Way {
  ExecutionOptions execution = {.threads = 3};
  int in_flight = 3;
  bool keep_going = false;
  std::optional<FrameRange> frames = {};
  std::optional<Shard> shard = {};
  int stop_after = 1 << 30;           ///< frames delivered
  int stop_after_fetching = 1 << 30;  ///< frames
};

class SequenceRunnerTest : public testing::Test {
 protected:
  SequenceRunnerTest() {
    options_.match.method = MatchMethod::kSsd;
    options_.match.disparities = {0, 9};
    options_.match.parameters.window_px = 5;
    options_.chunk_frames = 4;
    cameras_.width_px = 37;
    cameras_.height_px = 23;
    cameras_.baseline = 2;
    cameras_.left.matrix << 40, 0, 18, 0, 40, 11, 0, 0, 1;
    cameras_.right.matrix = cameras_.left.matrix;
  }

  /// Runs what is missing in `folder`; joins videos when nothing is any more.
  SequenceReport run(MadeUpPairs& pairs, const fs::path& folder, const Way& way) {
    Execution execution(way.execution);
    std::atomic<bool> stop{false};
    const SequenceLayout layout(folder, options_);
    const std::string part =
        way.shard ? "part-" + std::to_string(way.shard->index) : std::string("all");
    RunIdentity identity;
    identity.frame_count = pairs.pair_count();
    RunJournal journal(layout.journal_folder(), identity, JournalOpening::kResume, part);
    SequenceRun sequence{.pairs = pairs,
                         .selection = {.frame_count = pairs.pair_count(),
                                       .chunk_frames = options_.chunk_frames,
                                       .frames = way.frames,
                                       .shard = way.shard},
                         .frame_size = ImageExtent{37, 23},
                         .cameras = &cameras_,
                         .in_flight = way.in_flight,
                         .keep_going = way.keep_going,
                         .on_progress =
                             [&](const SequenceProgress& now) {
                               progress_ = now;
                               if (now.frames_done >= way.stop_after) {
                                 stop.store(true);
                               }
                             },
                         .stop = &stop};
    pairs.after_fetch = [&, before = pairs.fetched] {
      if (pairs.fetched - before >= way.stop_after_fetching) {
        stop.store(true);
      }
    };
    SequenceReport report = SequenceRunner(options_, execution).run(sequence, layout, journal);
    pairs.after_fetch = [] {};
    const DeliveredFrames delivered(layout);
    if (report.frames + report.pictures_again > 0 &&
        delivered.missing({0, pairs.pair_count()}).empty()) {
      join_segments(options_, layout, identity, {0, pairs.pair_count()}, true, journal);
    }
    return report;
  }
  SequenceReport run(MadeUpPairs& pairs, const fs::path& folder) { return run(pairs, folder, {}); }

  /// What run() throws as Error; empty if it does not.
  std::string error_of(MadeUpPairs& pairs, const fs::path& folder, const Way& way = {}) {
    try {
      run(pairs, folder, way);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  /// Relative name → content of all files but the journal's.
  static std::map<std::string, std::string> files(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string name = entry.path().lexically_relative(folder).string();
      if (entry.is_regular_file() && !name.starts_with(".vantage")) {
        std::ostringstream text;
        text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
        contents[name] = text.str();
      }
    }
    return contents;
  }
  static std::vector<std::string> names(const fs::path& folder) {
    std::vector<std::string> list;
    for (const auto& [name, content] : files(folder)) {
      list.push_back(name);
    }
    return list;
  }
  /// Whether the file is an image of just these values.
  static bool holds(const fs::path& file, const Image<std::uint8_t>& expected) {
    const Photograph read = read_photograph(file.string());
    const auto& image = std::get<Image<std::uint8_t>>(read.pixels);
    bool same = image.width() == expected.width() && image.height() == expected.height();
    for (int y = 0; same && y < image.height(); ++y) {
      same = std::equal(image.row(y), image.row(y) + image.width(), expected.row(y));
    }
    return same;
  }
  [[nodiscard]] fs::path folder(const std::string& name) const { return temporary_ / name; }

  TemporaryFolder temporary_;
  SequenceOptions options_;
  RectifiedPair cameras_;
  SequenceProgress progress_;
};

TEST_F(SequenceRunnerTest, WritesWhatTheMatcherComputes) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kUnmatched};
  options_.match.reference = Side::kRight;
  MadeUpPairs pairs(4);
  const SequenceReport report = run(pairs, folder("a"));
  EXPECT_EQ(progress_.frames_done, 4);
  EXPECT_EQ(progress_.frames_total, 4);
  EXPECT_EQ(progress_.cells, report.cells);
  EXPECT_EQ(report.frames, 4);
  EXPECT_FALSE(report.interrupted);
  EXPECT_EQ(report.cells, 4.0 * 37 * 23 * 10 * 2);
  EXPECT_GT(report.compute_seconds, 0);

  MadeUpPairs again(4);
  Execution serial({.executor = scheduler::ExecutorKind::kSerial});
  const StereoMatcher matcher(options_.match, serial);
  FramePair pair;
  DisparityMaps maps;
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_TRUE(again.fetch(pair));
    again.decode(pair);
    matcher.match(pair.left, pair.right, {}, maps);
    const std::string name = "00000" + std::to_string(frame);
    const DisparityMap map = read_disparity(folder("a") / "disparity" / (name + ".pfm"));
    const Photograph mask = read_photograph(folder("a") / "unmatched" / (name + ".png"));
    for (const auto [x, y] : positions_of(map)) {
      ASSERT_EQ(map.at(x, y), maps.right.disparity_px.at(x, y));
      ASSERT_EQ(std::get<Image<std::uint8_t>>(mask.pixels).at(x, y), maps.right.unmatched.at(x, y));
    }
  }
}

TEST_F(SequenceRunnerTest, OutputsGoToFoldersOfTheirOwn) {
  options_.save = {SequenceOutput::kViews, SequenceOutput::kHoles, SequenceOutput::kStereo,
                   SequenceOutput::kRightUnmatched};
  options_.views = {ViewPath::fixed(BaselinePosition{0.25, 0}),
                    ViewPath::fixed(BaselinePosition{-1, 0}), parse_view_path("0=0,9=1")};
  options_.stereo_packing = StereoPacking{.layout = StereoLayout::kAboveBelow};
  MadeUpPairs pairs(1);
  run(pairs, folder("a"));
  EXPECT_THAT(names(folder("a")),
              ElementsAre("holes/-1/000000.png", "holes/0.25/000000.png", "holes/path-1/000000.png",
                          "right-unmatched/000000.png", "stereo/000000.png", "views/-1/000000.png",
                          "views/0.25/000000.png", "views/path-1/000000.png"));
  EXPECT_EQ(read_photograph(folder("a") / "stereo/000000.png").height(), 46);
  options_.views.resize(1);
  options_.save = {SequenceOutput::kViews};
  run(pairs, folder("b"));
  EXPECT_THAT(names(folder("b")), ElementsAre("views/000000.png"));
  EXPECT_EQ(files(folder("b"))["views/000000.png"], files(folder("a"))["views/0.25/000000.png"]);
}

TEST_F(SequenceRunnerTest, AMovingViewIsTheFixedOneOfEachFrame) {
  options_.save = {SequenceOutput::kViews};
  options_.views = {parse_view_path("1=0.5,3=1.5")};
  MadeUpPairs pairs(4);
  run(pairs, folder("path"), {.frames = FrameRange{2, 4}});
  options_.views = {ViewPath::fixed(BaselinePosition{1, 0})};
  run(pairs, folder("fixed"));
  EXPECT_THAT(names(folder("path")), ElementsAre("views/000002.png", "views/000003.png"));
  EXPECT_EQ(files(folder("path"))["views/000002.png"], files(folder("fixed"))["views/000002.png"]);
}

TEST_F(SequenceRunnerTest, CamerasSeeWhatTheSynthesizerRenders) {
  options_.save = {SequenceOutput::kViews, SequenceOutput::kHoles, SequenceOutput::kSources};
  PosedCamera large = camera_looking_at(cameras_, {0.5, -0.25}, 3);
  large.width_px = 45;
  large.height_px = 19;
  PosedCamera sizeless = camera_looking_at(cameras_, {0, 0}, 4);
  sizeless.width_px = 0;
  sizeless.height_px = 0;
  PosedCamera moved = sizeless;
  moved.translation.y() -= 0.5;
  options_.views = {ViewPath::fixed(large), ViewPath{{{0, sizeless}, {2, moved}}}};
  for (const WarpColour warp : {WarpColour::kOnePass, WarpColour::kForward}) {
    options_.synthesis.warp = warp;
    const fs::path out = folder(warp == WarpColour::kForward ? "forward" : "one-pass");
    MadeUpPairs pairs(3);
    run(pairs, out);
    Execution serial({.executor = scheduler::ExecutorKind::kSerial});
    MadeUpPairs again(3);
    FramePair pair;
    DisparityMaps maps;
    for (int frame = 0; frame < 3; ++frame) {
      ASSERT_TRUE(again.fetch(pair));
      again.decode(pair);
      StereoMatcher(options_.match, serial).match(pair.left, pair.right, {}, maps);
      const auto compare = [&](const std::string& name, const PosedCamera& camera) {
        SynthesizedView view;
        if (warp == WarpColour::kForward) {
          ThreeStepSynthesizer(options_.synthesis, serial)
              .synthesize({pair.left, pair.right, maps.left.disparity_px.view(),
                           maps.right.disparity_px.view()},
                          cameras_, camera, view);
        } else {
          ViewSynthesizer(options_.synthesis, serial)
              .synthesize({pair.left, pair.right, maps.left.disparity_px.view(),
                           maps.right.disparity_px.view()},
                          camera_view(cameras_, camera), view);
        }
        const std::string file = name + "/00000" + std::to_string(frame) + ".png";
        const auto& image = std::get<Image<std::uint8_t>>(view.image.pixels);
        EXPECT_TRUE(holds(out / "views" / file, image));
        EXPECT_TRUE(holds(out / "holes" / file, view.holes));
        EXPECT_TRUE(holds(out / "sources" / file, view.sources));
      };
      compare("camera-1", large);
      auto between = std::get<PosedCamera>(options_.views[1].at(frame));
      between.width_px = 37;
      between.height_px = 23;
      compare("path-1", between);
    }
  }
}

TEST_F(SequenceRunnerTest, PositionsMayBeTurnedTowardsAPoint) {
  options_.save = {SequenceOutput::kViews};
  options_.look_at_px = 4;
  options_.views = {parse_view_path("0=0.5,3=2")};
  MadeUpPairs pairs(2);
  run(pairs, folder("turned"));
  options_.look_at_px.reset();
  options_.views = {ViewPath::fixed(camera_looking_at(cameras_, {1, 0}, 4))};
  run(pairs, folder("camera"));
  EXPECT_EQ(files(folder("turned"))["views/000001.png"],
            files(folder("camera"))["views/000001.png"]);
  options_.views = {ViewPath::fixed(BaselinePosition{1, 0})};
  run(pairs, folder("ahead"));
  EXPECT_NE(files(folder("turned"))["views/000001.png"],
            files(folder("ahead"))["views/000001.png"]);
}

TEST_F(SequenceRunnerTest, VideosOfCamerasHaveTheirSizeThroughout) {
  options_.save = {SequenceOutput::kViews};
  options_.video = options_.save;
  options_.chunk_frames = 2;
  PosedCamera camera = camera_looking_at(cameras_, {0.5, 0}, 3);
  camera.width_px = 50;
  camera.height_px = 30;
  options_.views = {ViewPath::fixed(camera)};
  MadeUpPairs pairs(4);
  pairs.bad_to_decode = {0, 1};  // a whole segment
  run(pairs, folder("a"), {.keep_going = true});
  VideoReader reader((folder("a") / "views.mp4").string());
  Photograph frame;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(reader.read(frame));
    EXPECT_EQ(frame.width(), 50);
    EXPECT_EQ(frame.height(), 30);
  }
  EXPECT_FALSE(reader.read(frame));
}

TEST_F(SequenceRunnerTest, TheFirstBadFrameEndsTheRun) {
  MadeUpPairs pairs(6);
  pairs.bad_to_decode = {4};
  pairs.uneven = {2};
  const std::string error = error_of(pairs, folder("a"));
  EXPECT_THAT(error, HasSubstr("frame 2 (left 2, right 2): the left image is 7x23"));
  EXPECT_THAT(error, HasSubstr("expected 37x23"));
  EXPECT_THAT(names(folder("a")), ElementsAre("disparity/000000.pfm", "disparity/000001.pfm"));
  MadeUpPairs unreadable(6);
  unreadable.bad_to_fetch = {1};
  EXPECT_EQ(error_of(unreadable, folder("b")), "frame 1 (left 1, right 1): the stream is damaged");
  MadeUpPairs narrow(6);
  narrow.narrow = {0};
  EXPECT_THAT(error_of(narrow, folder("c")), HasSubstr("is 29x23, expected 37x23 as at the start"));
}

TEST_F(SequenceRunnerTest, FramesThatASourceOnlyPromisedAreDoneWith) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kPreview};
  options_.video = {SequenceOutput::kPreview};
  MadeUpPairs pairs(8);
  pairs.ends_at = 6;
  const SequenceReport report = run(pairs, folder("a"));
  EXPECT_EQ(report.frames, 6);
  ASSERT_EQ(report.remarks.size(), 2U);
  EXPECT_EQ(report.remarks[0].frame, 6);
  EXPECT_THAT(report.remarks[0].text, HasSubstr("the input ends before it"));
  EXPECT_EQ(names(folder("a")).size(), 6U + 1);
  EXPECT_EQ(VideoReader(folder("a") / "preview.mp4").frame_count(), 6);
  const SequenceReport again = run(pairs, folder("a"));
  EXPECT_EQ(again.frames, 0);
  EXPECT_EQ(again.frames_before, 8);
  // A whole chunk that is not there.
  pairs.ends_at = 4;
  EXPECT_EQ(run(pairs, folder("b")).frames, 4);
  EXPECT_EQ(VideoReader(folder("b") / "preview.mp4").frame_count(), 4);
  EXPECT_EQ(run(pairs, folder("b")).frames_before, 8);
  EXPECT_EQ(run(pairs, folder("c"), {.frames = FrameRange{4, 8}}).remarks.size(), 4U);
  EXPECT_EQ(run(pairs, folder("c")).frames, 4);
  EXPECT_EQ(files(folder("c")), files(folder("b")));
}

TEST_F(SequenceRunnerTest, VideosOfPiecesOfAChunkAreMadeAnew) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kPreview};
  options_.video = {SequenceOutput::kPreview};
  MadeUpPairs pairs(4);
  run(pairs, folder("whole"));
  run(pairs, folder("a"), {.frames = FrameRange{0, 3}});
  EXPECT_THAT(error_of(pairs, folder("a"), {.frames = FrameRange{1, 4}}),
              HasSubstr("frame 3 is in no video segment that continues the one before"));
  const SequenceReport again = run(pairs, folder("a"));
  EXPECT_EQ(again.frames, 0);
  EXPECT_EQ(again.pictures_again, 4);
  EXPECT_TRUE(files(folder("a")) == files(folder("whole")));
}

TEST_F(SequenceRunnerTest, FramesOfAnUnfinishedVideoAreNotReported) {
  options_.save = {SequenceOutput::kPreview};
  options_.video = options_.save;
  MadeUpPairs pairs(400);
  const SequenceReport report = run(pairs, folder("a"), {.stop_after = 6});
  EXPECT_TRUE(report.interrupted);
  EXPECT_GE(report.frames, 4);
  EXPECT_EQ(report.frames % 4, 0);
  const DeliveredFrames delivered(SequenceLayout(folder("a"), options_));
  EXPECT_EQ(delivered.records().size(), static_cast<std::size_t>(report.frames));
}

TEST_F(SequenceRunnerTest, BadFramesAreSkippedWhereAskedAndMadeOnceRepaired) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kPreview};
  for (const bool video : {false, true}) {
    options_.video.clear();
    if (video) {
      options_.video = {SequenceOutput::kPreview};
    }
    const std::string name = video ? "video" : "images";
    MadeUpPairs whole(11);
    run(whole, folder(name + "-whole"));
    MadeUpPairs pairs(11);
    pairs.bad_to_fetch = {0, 6};
    pairs.bad_to_decode = {1, 5, 8, 9, 10};
    const SequenceReport report = run(pairs, folder(name), {.keep_going = true});
    EXPECT_EQ(report.frames, 4);
    ASSERT_EQ(report.skipped.size(), 7U);
    EXPECT_EQ(report.skipped[1].frame, 1);
    EXPECT_THAT(report.skipped[1].text, HasSubstr("left 1: is truncated"));
    if (video) {
      VideoReader reader(folder(name) / "preview.mp4");
      EXPECT_EQ(reader.frame_count(), 11);
    }
    MadeUpPairs repaired(11);
    const SequenceReport again = run(repaired, folder(name), {.keep_going = true});
    EXPECT_EQ(again.frames, 7);
    EXPECT_EQ(again.pictures_again, video ? 4 : 0);  // all chunks have a bad frame
    EXPECT_THAT(again.skipped, IsEmpty());
    EXPECT_EQ(files(folder(name)), files(folder(name + "-whole")));
  }
}

TEST_F(SequenceRunnerTest, SkippedFramesOfAVideoShowANeighbour) {
  options_.save = {SequenceOutput::kViews};
  options_.video = options_.save;
  options_.views = {ViewPath::fixed(BaselinePosition{0, 0})};
  options_.crf = 0;
  const auto frames_of = [&](const std::set<int>& bad) {
    MadeUpPairs pairs(8);
    pairs.bad_to_decode = bad;
    const fs::path out = folder("bad" + std::to_string(bad.size()));
    run(pairs, out, {.keep_going = true});
    VideoReader reader(out / "views.mp4");
    std::vector<Photograph> frames(8);
    for (Photograph& frame : frames) {
      EXPECT_TRUE(reader.read(frame));
    }
    return frames;
  };
  const auto distance = [](const Photograph& a, const Photograph& b) {
    double sum = 0;
    const auto& first = std::get<Image<std::uint8_t>>(a.pixels);
    const auto& second = std::get<Image<std::uint8_t>>(b.pixels);
    for (const auto [x, y] : positions_of(first)) {
      sum += std::abs(first.at(x, y) - second.at(x, y));
    }
    return sum / (first.width() * first.height());
  };
  const auto good = frames_of({});
  ASSERT_GT(distance(good[1], good[2]), 20);
  const auto some = frames_of({0, 1, 3});
  for (const auto& [frame, shows] :
       std::map<int, int>{{0, 2}, {1, 2}, {2, 2}, {3, 2}, {4, 4}, {7, 7}}) {
    EXPECT_LT(
        distance(some[static_cast<std::size_t>(frame)], good[static_cast<std::size_t>(shows)]), 2)
        << frame;
  }
  const auto none = frames_of({4, 5, 6, 7});  // a segment without a good frame
  EXPECT_LT(distance(none[3], good[3]), 2);
  const auto& black = std::get<Image<std::uint8_t>>(none[5].pixels);
  EXPECT_LT(black.at(3, 3), 3);
}

/// A group has 50 frames, whatever runs them; here its first frame repeats the last one before it.
TEST_F(SequenceRunnerTest, VideosOfSeveralGroupsAreTheSameHoweverTheyAreMade) {
  options_.save = {SequenceOutput::kPreview};
  options_.video = options_.save;
  options_.chunk_frames = 60;
  constexpr int kFrames = 74;
  const auto make = [&](const std::string& name, const Way& way) {
    MadeUpPairs pairs(kFrames);
    pairs.bad_to_decode = {50};
    run(pairs, folder(name), way);
    return files(folder(name));
  };
  const auto expected =
      make("a", {.execution = {.threads = 1}, .in_flight = 1, .keep_going = true});
  EXPECT_EQ(VideoReader(folder("a") / "preview.mp4").frame_count(), kFrames);
  EXPECT_EQ(make("b", {.execution = {.threads = 3}, .in_flight = 9, .keep_going = true}), expected);
  EXPECT_EQ(make("c", {.execution = {.threads = 2, .executor = scheduler::ExecutorKind::kOpenMp},
                       .in_flight = 3,
                       .keep_going = true}),
            expected);
}

TEST_F(SequenceRunnerTest, PartsAndInterruptionsLeaveNoTrace) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kRightDisparity,
                   SequenceOutput::kPreview, SequenceOutput::kViews};
  options_.views = {ViewPath::fixed(BaselinePosition{0.5, 0})};
  options_.video = {SequenceOutput::kPreview};
  options_.temporal.weight = 1;
  MadeUpPairs pairs(14);
  pairs.repeat = {3, 9, 10};
  run(pairs, folder("whole"));
  const auto expected = files(folder("whole"));
  EXPECT_EQ(expected.size(), 14U * 3 + 1);
  for (const int shards : {2, 7}) {
    const fs::path out = folder("shards" + std::to_string(shards));
    for (int index = shards; index >= 1; --index) {
      run(pairs, out, {.in_flight = 1 + index % 4, .shard = Shard{index, shards}});
    }
    EXPECT_EQ(files(out), expected) << shards;
  }
  const fs::path out = folder("interrupted");
  int runs = 0;
  for (bool done = false; !done && runs < 40; ++runs) {
    done = !run(pairs, out, {.in_flight = 2, .stop_after_fetching = 1 + 2 * runs}).interrupted;
  }
  EXPECT_GT(runs, 1);
  EXPECT_EQ(files(out), expected);
}

TEST_F(SequenceRunnerTest, LostFilesAreMadeAgain) {
  MadeUpPairs pairs(9);
  run(pairs, folder("a"));
  const auto expected = files(folder("a"));
  fs::remove(folder("a") / "disparity/000003.pfm");
  std::ofstream(folder("a") / "disparity/000005.pfm").close();  // empty
  fs::resize_file(folder("a") / "disparity/000007.pfm", 700);
  pairs.fetched = 0;
  pairs.skip_to(0);
  EXPECT_EQ(run(pairs, folder("a")).frames, 3);
  EXPECT_EQ(pairs.fetched, 3);
  EXPECT_EQ(files(folder("a")), expected);
}

TEST_F(SequenceRunnerTest, LeftoversOfAKilledProcessAreRemoved) {
  const fs::path disparity = folder("a") / "disparity";
  fs::create_directories(disparity);
  for (const char* name :
       {".000001.tmp-0123abcd-4711-0.pfm", ".000002.tmp-0123abcd-12-0.pfm",
        ".000007.tmp-0123abcd-4711-0.pfm", ".000001.tmp-mine", ".keep", ".notes.tmp-x"}) {
    std::ofstream(disparity / name) << "x";
  }
  MadeUpPairs pairs(9);
  run(pairs, folder("a"), {.frames = FrameRange{0, 4}});
  const auto left = names(folder("a"));
  EXPECT_THAT(left,
              ElementsAre("disparity/.000001.tmp-mine", "disparity/.000007.tmp-0123abcd-4711-0.pfm",
                          "disparity/.keep", "disparity/.notes.tmp-x", "disparity/000000.pfm",
                          "disparity/000001.pfm", "disparity/000002.pfm", "disparity/000003.pfm"));
}

TEST_F(SequenceRunnerTest, AResultThatCannotBeWrittenEndsTheRunEvenWhenItKeepsGoing) {
  fs::create_directories(folder("a") / "disparity/000002.pfm");
  MadeUpPairs pairs(40);
  const std::string error = error_of(pairs, folder("a"), {.keep_going = true});
  EXPECT_THAT(error, HasSubstr("cannot write"));
  EXPECT_THAT(error, HasSubstr("disparity/000002.pfm"));
  EXPECT_THAT(names(folder("a")), ElementsAre("disparity/000000.pfm", "disparity/000001.pfm"));
  fs::remove(folder("a") / "disparity/000002.pfm");
  EXPECT_EQ(run(pairs, folder("a")).frames_before, 2);
  // A folder in which no file can be made.
  fs::create_directories(folder("b"));
  fs::create_directory_symlink("/proc", folder("b") / "disparity");
  EXPECT_THAT(
      error_of(pairs, folder("b"), {.keep_going = true}),
      testing::ContainsRegex("^frame 0: cannot write .*/b/disparity/000000.pfm: No such file"));
}

TEST_F(SequenceRunnerTest, RepeatedFramesAreRemarked) {
  MadeUpPairs pairs(6);
  pairs.repeat = {2, 5};
  const SequenceReport report = run(pairs, folder("a"));
  ASSERT_EQ(report.remarks.size(), 2U);
  EXPECT_EQ(report.remarks[0].frame, 2);
  EXPECT_EQ(report.remarks[1].text, "both images are the same as in frame 4");
}

TEST(BusyClock, CountsOverlappingActivitiesOnce) {
  BusyClock clock;
  const auto start = std::chrono::steady_clock::now();
  {
    const BusyClock::Activity outer(clock);
    const BusyClock::Activity inner(clock);
  }
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(clock.seconds(), 0);
  EXPECT_LE(clock.seconds(), elapsed);
}

}  // namespace vantage::sequence_runner_test
