// Runs whose input is damaged, incomplete or not what it was.

#include <numeric>

#include "engine/io/video/video_io.h"
#include "tests/apps/run_fixture.h"

namespace vantage::run_sources_test {

constexpr int kBad = 7;

std::vector<int> numbers(int first, int end) {
  std::vector<int> all(end - first);
  std::iota(all.begin(), all.end(), first);
  return all;
}

class RunSources : public RunTest {
 protected:
  [[nodiscard]] std::string file(const std::string& side, int frame) const {
    return folder_ / (side + "/" + frame_file(frame));
  }

  /// Without --keep-going the run ends there and says why; what is before it is done.
  void expect_stop_at(int frame, const std::string& source, const std::string& says) const {
    const ProcessResult result = run(out_, {"--quiet"});
    expect_one_line(result, 1, "run", "frame " + std::to_string(frame));
    EXPECT_THAT(result.err, HasSubstr(source));
    EXPECT_THAT(result.err, HasSubstr(says));
    EXPECT_EQ(journalled_frames(out_), numbers(0, frame));
    EXPECT_EQ(results_in(out_).size(), static_cast<std::size_t>(frame));
    EXPECT_THAT(leftovers_in(out_), IsEmpty());
  }

  /// With --keep-going all others are made; the report and the journal tell of those left out.
  void expect_skipped(const std::vector<int>& frames, const Words& outputs = {}) const {
    const std::string report = folder_ / "report.json";
    const ProcessResult result =
        run(out_, joined(outputs, {"--resume", "--keep-going", "--report", report}));
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_EQ(journalled_frames(out_, true), frames);
    EXPECT_EQ(journalled_frames(out_).size(), kFrames - frames.size());
    const nlohmann::json results = read_json(report)["results"];
    ASSERT_EQ(results["skipped"].size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(results["skipped"][i]["frame"], frames[i]);
      EXPECT_FALSE(fs::exists(out_ + "/disparity/" + frame_file(frames[i], "pfm")));
    }
  }

  /// The sources are whole again: what was skipped is made.
  void expect_repaired(const FolderContent& expected, const Words& outputs = {}) const {
    const std::string report = folder_ / "report.json";
    const Words again = joined(outputs, {"--resume", "--report", report});
    expect_one_line(run(out_, joined(again, {"--quiet"})), 1, "run", "the input was");
    succeeds(run(out_, joined(again, {"--force"})));
    EXPECT_TRUE(same_files(results_in(out_), expected));
    EXPECT_THAT(journalled_frames(out_, true), IsEmpty());
  }

  void break_and_repair(const std::string& side, const std::string& broken_bytes,
                        const std::string& says) {
    const FolderContent expected = undisturbed({});
    const std::string whole = frame_bytes(side, kBad);
    write_file(file(side, kBad), broken_bytes);
    expect_stop_at(kBad, file(side, kBad), says);
    expect_skipped({kBad});
    write_file(file(side, kBad), whole);
    expect_repaired(expected);
    EXPECT_EQ(read_json(folder_ / "report.json")["results"]["frames"], 1);
  }

  std::string out_ = folder_ / "out";
};

using InputRunSources = RunSources;

TEST_F(InputRunSources, APngThatIsCutOff) {
  break_and_repair("left", frame_bytes("left", kBad).substr(0, 900), "");
}

TEST_F(RunSources, AFrameOfAnotherSizeOnOneSide) {
  const std::string other = file("left", kBad) + ".png";
  write_photograph(other, {Image<std::uint8_t>(kWidth + 1, kHeight)});
  const std::string bytes = read_file(other);
  fs::remove(other);
  break_and_repair("left", bytes, "65x48");
}

TEST_F(InputRunSources, AFrameOfAnotherSizeOnBothSides) {
  const FolderContent expected = undisturbed({});
  const std::string left = frame_bytes("left", kBad);
  const std::string right = frame_bytes("right", kBad);
  for (const std::string side : {"left", "right"}) {
    write_photograph(file(side, kBad), {Image<std::uint8_t>(kWidth, kHeight - 9)});
  }
  expect_stop_at(kBad, file("left", kBad), "64x39, expected 64x48");
  expect_skipped({kBad});
  write_file(file("left", kBad), left);
  write_file(file("right", kBad), right);
  expect_repaired(expected);
  EXPECT_EQ(read_json(folder_ / "report.json")["results"]["frames"], 1);
}

TEST_F(RunSources, BadFramesBeforeOthersThatBuildOnThem) {
  const Words outputs = {"--chunk-frames", "10", "--temporal-prior", "1"};
  const FolderContent expected = undisturbed(outputs);
  const std::string whole = frame_bytes("left", 3);
  write_file(file("left", 3), "");
  expect_skipped({3}, outputs);
  write_file(file("left", 3), whole);
  // Those behind it in its chunk were made without it, so they are made again.
  expect_repaired(expected, outputs);
  EXPECT_EQ(read_json(folder_ / "report.json")["results"]["frames"], 7);
}

TEST_F(InputRunSources, AllFramesBad) {
  for (int frame = 0; frame < kFrames; ++frame) {
    write_file(file("left", frame), "");
  }
  expect_one_line(run(out_, {"--quiet", "--keep-going"}), 1, "run");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(RunSources, TheFirstFramesBad) {
  for (int frame = 0; frame < 3; ++frame) {
    write_file(file("left", frame), "");
  }
  expect_one_line(run(out_, {"--quiet"}), 1, "run", "frame 0 ");
  expect_skipped({0, 1, 2});
}

/// Segments of a chunk without any picture are black, in the size of the others.
TEST_F(RunSources, AllFramesOfTheFirstChunkBad) {
  for (int frame = 0; frame < 5; ++frame) {
    write_file(file("left", frame), "");
  }
  EXPECT_EQ(run(out_, joined(words("--save stereo,preview,depth-video --video stereo,preview "
                                   "--depth-range -1:10 --chunk-frames 5"),
                             {"--keep-going"}))
                .exit_code,
            3);
  for (const std::string video : {"stereo.mp4", "preview.mp4", "depth-video.mkv"}) {
    VideoReader reader(out_ + "/" + video);
    EXPECT_EQ(reader.frame_count(), kFrames) << video;
    for (const int frame : {0, 4, 5}) {
      ASSERT_TRUE(frame == 0 || frame == 5 || (reader.skip() && reader.skip() && reader.skip()));
      Photograph picture;
      ASSERT_TRUE(reader.read(picture));
      const bool is_black = std::visit(
          [](const auto& image) {
            const auto* const row = image.row(kHeight / 2);
            return std::all_of(row, row + image.width() * image.channels(),
                               [](auto value) { return value == 0; });
          },
          picture.pixels);
      EXPECT_EQ(is_black, frame < 5) << video << " " << frame;
    }
  }
}

/// A number that is missing is a frame that is: those behind it keep their partners.
TEST_F(RunSources, AMissingNumberOfAPattern) {
  const FolderContent expected = undisturbed({});
  const auto with_patterns = [&](const Words& more) {
    return run_vantage(
        joined({"run", "--left", left_ + "/%06d.png", "--right", right_ + "/%06d.png", "-o", out_,
                "--disparities=0:9", "--method", "ssd"},
               more));
  };
  fs::rename(file("right", kBad), folder_ / "kept.png");
  const ProcessResult stopped = with_patterns({"--quiet"});
  expect_one_line(stopped, 1, "run", "frame " + std::to_string(kBad));
  EXPECT_THAT(stopped.err, HasSubstr(file("right", kBad)));
  EXPECT_EQ(journalled_frames(out_), numbers(0, kBad));
  EXPECT_EQ(with_patterns({"--resume", "--keep-going"}).exit_code, 3);
  EXPECT_THAT(journalled_frames(out_, true), ElementsAre(kBad));
  fs::rename(folder_ / "kept.png", file("right", kBad));
  succeeds(with_patterns({"--resume", "--force"}));
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

TEST_F(InputRunSources, UnequalLengths) {
  for (int frame = 15; frame < kFrames; ++frame) {
    fs::remove(file("right", frame));
  }
  const Words in_order = {"--pair-by", "order", "--quiet"};
  const ProcessResult result = run(out_, in_order);
  expect_one_line(result, 1, "run", "all 15 pairs are done");
  EXPECT_THAT(result.err, HasSubstr("5 frames more"));
  EXPECT_EQ(journalled_frames(out_), numbers(0, 15));
  EXPECT_EQ(run(out_, joined(in_order, {"--resume", "--keep-going"})).exit_code, 3);
  succeeds(run(out_, joined(in_order, {"--overwrite", "--frames", "0-14"})));
}

class RunVideoSources : public RunSources {
 protected:
  RunVideoSources() {
    for (const std::string side : {"left", "right"}) {
      VideoWriter video(folder_ / (side + ".mp4"), kWidth, kHeight, VideoEncoding());
      std::string raw = "YUV4MPEG2 W64 H48 F25:1 Ip A1:1 Cmono\n";
      for (int frame = 0; frame < kFrames; ++frame) {
        const Photograph picture = read_photograph(file(side, frame));
        video.write(picture);
        const auto& image = std::get<Image<std::uint8_t>>(picture.pixels);
        raw += "FRAME\n";
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            raw += static_cast<char>(image.at(x, y, 1));
          }
        }
      }
      video.finish();
      write_file(folder_ / (side + ".y4m"), raw);
    }
  }
  /// Runs on a right video of which not all can be read. Returns its first bad frame.
  [[nodiscard]] int lose_the_end(const std::string& extension) const {
    const ProcessResult stopped = run_videos(extension, {"--quiet"});
    expect_one_line(stopped, 1, "run");
    const std::vector<int> done = journalled_frames(out_);
    const auto first_bad = static_cast<int>(done.size());
    EXPECT_THAT(stopped.err, HasSubstr("right." + extension + ": frame " +
                                       std::to_string(first_bad) + " cannot be decoded"));
    EXPECT_EQ(done, numbers(0, first_bad));
    EXPECT_GT(first_bad, 0);
    EXPECT_LT(first_bad, 18);
    const ProcessResult kept_going = run_videos(extension, {"--resume", "--keep-going"});
    EXPECT_EQ(kept_going.exit_code, 3) << kept_going.err;
    EXPECT_EQ(journalled_frames(out_, true), numbers(first_bad, kFrames));
    return first_bad;
  }
  void repair_the_end(const std::string& extension, const std::string& whole, int first_bad) const {
    write_file(folder_ / ("right." + extension), whole);
    succeeds(run_videos(extension, {"--resume", "--force", "--report", folder_ / "report.json"}));
    EXPECT_EQ(read_json(folder_ / "report.json")["results"]["frames"], kFrames - first_bad);
  }
  [[nodiscard]] ProcessResult run_videos(const std::string& extension, const Words& more) const {
    return run_vantage(joined(
        {"run", "--left", folder_ / ("left." + extension), "--right",
         folder_ / ("right." + extension), "-o", out_, "--disparities=0:9", "--method", "ssd"},
        more));
  }
};

using InputVideoSources = RunVideoSources;

TEST_F(InputVideoSources, AVideoWithDamageInTheMiddle) {
  succeeds(run_videos("mp4", {}));
  FolderContent expected = results_in(out_);
  fs::remove_all(out_);
  const std::string whole = read_file(folder_ / "right.mp4");
  std::string damaged = whole;
  for (std::size_t i = whole.size() * 6 / 10; i < whole.size() * 6 / 10 + 400; ++i) {
    damaged[i] = static_cast<char>(damaged[i] ^ 0x5a);
  }
  write_file(folder_ / "right.mp4", damaged);
  const int first_bad = lose_the_end("mp4");
  // Other bytes can be another valid picture, so frames right before may have been damaged as well.
  for (int frame = 0; frame < first_bad; ++frame) {
    expected.erase("disparity/" + frame_file(frame, "pfm"));
  }
  repair_the_end("mp4", whole, first_bad);
  for (const auto& [name, bytes] : expected) {
    EXPECT_EQ(read_file(out_ + "/" + name), bytes) << name;
  }
}

/// What cannot be opened is refused before anything else happens.
TEST_F(InputVideoSources, AVideoThatIsNoneOrWithoutIndex) {
  succeeds(run_videos("mp4", {"--frames", "0-9"}));
  const FolderContent finished = results_in(out_);
  const std::string whole = read_file(folder_ / "right.mp4");
  for (const std::size_t bytes : {0, 10, 100}) {
    write_file(folder_ / "right.mp4", whole.substr(0, bytes));
    for (const std::string opening : {"--resume", "--keep-going"}) {
      expect_one_line(run_videos("mp4", {"--quiet", opening}), 1, "run", "right.mp4");
      EXPECT_TRUE(same_files(results_in(out_), finished));
    }
  }
}

/// Nothing tells how many frames it had.
TEST_F(InputVideoSources, ARawVideoThatEndsInTheMiddleOfAFrame) {
  succeeds(run_videos("y4m", {}));
  const FolderContent expected = results_in(out_);
  fs::remove_all(out_);
  const std::string whole = read_file(folder_ / "right.y4m");
  write_file(folder_ / "right.y4m", whole.substr(0, whole.size() * 6 / 10));
  expect_one_line(run_videos("y4m", {"--quiet"}), 1, "run",
                  "right.y4m: frame 11 cannot be decoded");
  EXPECT_EQ(journalled_frames(out_), numbers(0, 11));
  EXPECT_EQ(run_videos("y4m", {"--resume", "--keep-going"}).exit_code, 3);
  EXPECT_EQ(journalled_frames(out_, true), numbers(11, 12));
  write_file(folder_ / "right.y4m", whole);
  succeeds(run_videos("y4m", {"--resume", "--force"}));
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

}  // namespace vantage::run_sources_test
