// Runs that read standard input and write a folder.

#include <regex>

#include "engine/io/video/video_io.h"
#include "tests/apps/stream_fixture.h"

namespace vantage::run_stream_folder_test {

constexpr int kFilm = 12;
constexpr int kFirstShot = 7;
/// Frames with a cut; two videos in segments of five frames.
const Words kFilmOutputs = words(
    "--save disparity,preview,depth-video,comfort --video preview --fps 24000/1001 "
    "--search-range film --chunk-frames 5 --disparities=0:9");

int frames_of(const fs::path& video) { return VideoReader(video).frame_count(); }

class RunStreamFolders : public StreamTest {
 protected:
  /// As y4m: `frames` pairs, from kFirstShot on upside down.
  void write_film(int frames) const {
    for (int frame = kFirstShot; frame < frames; ++frame) {
      for (const std::string& side : {left_, right_}) {
        const Photograph upright = read_photograph(side + "/" + frame_file(frame));
        const auto& pixels = std::get<Image<std::uint8_t>>(upright.pixels);
        Image<std::uint8_t> turned(pixels.width(), pixels.height(), pixels.channels());
        for (int y = 0; y < pixels.height(); ++y) {
          std::copy_n(pixels.row(pixels.height() - 1 - y), 3 * pixels.width(), turned.row(y));
        }
        write_photograph(side + "/" + frame_file(frame), Photograph{std::move(turned)});
      }
    }
    ASSERT_EQ(shell(command({"--left", left_, "--right", right_, "--frames",
                             "0-" + std::to_string(frames - 1), "--disparities=0:9", "--method",
                             "ssd", "--save", "stereo", "--stereo-packing", "sbsl", "--fps",
                             "24000/1001", "-o", "-", "--quiet"}) +
                    " >" + pairs_),
              0)
        << err();
  }
  /// Of standard input, or of a file.
  [[nodiscard]] Words options(const std::string& stereo, const std::string& out,
                              const Words& more) const {
    return joined({"--stereo", stereo, "--packing", "sbsl", "--method", "ssd", "-o", out}, more);
  }
  [[nodiscard]] int stream(const std::string& out, const Words& more) const {
    return shell(command(options("-", out, more)) + " <" + pairs_);
  }
  /// Bytes of one frame of the y4m.
  [[nodiscard]] std::size_t frame_bytes() const {
    return 6 + 2 * std::size_t{kWidth} * kHeight * 3 / 2;
  }

  std::string pairs_ = folder_ / "pairs.y4m";
  std::string out_ = folder_ / "out";
  std::string of_file_ = folder_ / "of_file";
};

/// Files that do not name the input.
FolderContent without_comfort(FolderContent files) {
  files.erase("comfort.html");
  files.erase("comfort.json");
  return files;
}

TEST_F(RunStreamFolders, AreAsOfAFile) {
  write_film(kFilm);
  ASSERT_EQ(stream(out_, kFilmOutputs), 0) << err();
  ASSERT_EQ(shell(command(options(pairs_, of_file_, kFilmOutputs))), 0) << err();
  EXPECT_TRUE(same_files(without_comfort(results_in(out_)), without_comfort(results_in(of_file_))));
  EXPECT_EQ(frames_of(out_ + "/preview.mp4"), kFilm);
  nlohmann::json comfort = read_json(out_ + "/comfort.json");
  nlohmann::json expected = read_json(of_file_ + "/comfort.json");
  EXPECT_EQ(comfort["shots"].size(), 2U);
  EXPECT_EQ(comfort["input"], "standard input");
  comfort.erase("input");
  expected.erase("input");
  EXPECT_EQ(comfort, expected);
  succeeds(run_vantage({"verify", out_}));
  succeeds(run_vantage({"merge", out_}));
  EXPECT_TRUE(same_files(without_comfort(results_in(out_)), without_comfort(results_in(of_file_))));
  // A folder holds one run.
  EXPECT_EQ(stream(out_, kFilmOutputs), 1);
  EXPECT_THAT(err(), HasSubstr("expected --overwrite"));
  EXPECT_EQ(stream(out_, joined(kFilmOutputs, {"--overwrite"})), 0) << err();
  // Without a stream there is nothing to continue.
  expect_failure(run_vantage({"run", "-o", out_, "--resume"}), 2,
                 "a stream, which cannot be read again");
}

TEST_F(RunStreamFolders, TakePartsAndStateAsOfAFile) {
  write_film(kFilm);
  const std::vector<Words> cases = {
      {"--frames", "3-8", "--temporal-prior", "1", "--chunk-frames", "5", "--disparities=0:9"},
      {"--every", "3+1", "--disparities=0:9"},
      {"--frames", "2-11:4", "--save", "preview", "--video", "preview", "--disparities=0:9"}};
  for (const Words& more : cases) {
    ASSERT_EQ(stream(out_, joined(more, {"--overwrite"})), 0) << err();
    ASSERT_EQ(shell(command(options(pairs_, of_file_, joined(more, {"--overwrite"})))), 0) << err();
    const FolderContent expected = results_in(of_file_);
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(same_files(results_in(out_), expected)) << more[1];
    fs::remove_all(out_);
    fs::remove_all(of_file_);
  }
  EXPECT_EQ(stream(out_, {"--frames", "40-50", "--disparities=0:9"}), 1);
  EXPECT_THAT(err(), HasSubstr("standard input frame 40: the stream ends before it"));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(RunStreamFolders, SearchTheRangeOfTheFirstPairs) {
  constexpr int kHeld = 16;
  fs::copy_file(left_ + "/" + frame_file(0), right_ + "/" + frame_file(0),
                fs::copy_options::overwrite_existing);  // nothing but disparity 0
  write_film(kFrames);
  ASSERT_EQ(stream(out_, {}), 0) << err();
  EXPECT_EQ(journalled_frames(out_).size(), std::size_t{kFrames});
  const std::string y4m = read_file(pairs_);
  write_file(pairs_, y4m.substr(0, y4m.size() - (kFrames - kHeld) * frame_bytes()));
  ASSERT_EQ(shell(command(options(pairs_, of_file_, {}))), 0) << err();
  const auto range_in = [](const std::string& folder) {
    return read_json(folder + "/.vantage/run.json")["settings"]["disparities"];
  };
  EXPECT_EQ(range_in(out_), range_in(of_file_));
}

TEST_F(RunStreamFolders, KeepWhatIsDoneWhenTheyEndEarly) {
  write_film(kFilm);
  ASSERT_EQ(stream(of_file_, kFilmOutputs), 0) << err();
  const std::string y4m = read_file(pairs_);
  write_file(pairs_, y4m.substr(0, y4m.size() - 4 * frame_bytes() + 100));
  EXPECT_EQ(stream(out_, joined(kFilmOutputs, {"--quiet"})), 1);
  EXPECT_THAT(err(), HasSubstr("standard input frame 8: the stream ends inside it"));
  EXPECT_THAT(err(), HasSubstr("8 frames before it are done"));
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1);
  FolderContent expected = results_in(of_file_ + "/disparity");
  std::erase_if(expected, [](const auto& file) { return file.first >= "000008"; });
  EXPECT_TRUE(same_files(results_in(out_ + "/disparity"), expected));
  EXPECT_EQ(frames_of(out_ + "/depth-video.mkv"), 8);
  EXPECT_EQ(read_json(out_ + "/comfort.json")["shots"].size(), 2U);
  EXPECT_TRUE(leftovers_in(out_).empty());
  succeeds(run_vantage({"verify", out_}));
  // A frame that cannot be had is skipped, and the run ends.
  EXPECT_EQ(stream(out_, joined(kFilmOutputs, {"--overwrite", "--keep-going"})), 3);
  EXPECT_THAT(err(), HasSubstr("skipped frame 8: standard input frame 8: the stream"));
  write_file(out_ + "/disparity/000001.pfm", "damaged");
  expect_failure(run_vantage({"verify", out_}), 1, "nothing but a new run");
}

TEST_F(RunStreamFolders, KeepWhatIsDoneWhenTheyAreStopped) {
  write_film(kFilm);
  const std::string pid = folder_ / "pid";
  for (const bool kill : {true, false}) {
    fs::remove_all(out_);
    // The pipe stays open, so that the run waits for more, and has read all there is.
    const std::string waits = "until grep -qs 000005-000009 " + out_ +
                              "/.vantage/frames-all.jsonl; do sleep 0.02; done; python3 -c 'import "
                              "array, fcntl, termios\n"
                              "unread = array.array(\"i\", [1])\n"
                              "while unread[0]: fcntl.ioctl(1, termios.FIONREAD, unread)'";
    const std::string process =
        "sh -c 'echo $$ >" + pid + "; exec env " +
        std::regex_replace(command(options("-", out_, kFilmOutputs)), std::regex("'"), "") + "'";
    EXPECT_EQ(shell("{ cat " + pairs_ + "; " + waits + "; kill -" + (kill ? "KILL" : "INT") +
                    " $(cat " + pid + "); sleep 0.1; } | " + process),
              kill ? 137 : 130)
        << err();
    succeeds(run_vantage({"verify", out_}));
    if (kill) {
      succeeds(run_vantage({"merge", out_}));
      EXPECT_GE(frames_of(out_ + "/preview.mp4"), 10);
      EXPECT_EQ(read_json(out_ + "/comfort.json")["shots"].size(), 1U);
    } else {
      EXPECT_EQ(frames_of(out_ + "/preview.mp4"), kFilm);
      EXPECT_EQ(read_json(out_ + "/comfort.json")["shots"].size(), 2U);
    }
  }
}

TEST_F(RunStreamFolders, AreStoppedWhileThePipeIsSilent) {
  const std::string raw = folder_ / "raw";
  const std::string pipe = folder_ / "pipe";
  const std::string size = std::to_string(2 * kWidth) + "x" + std::to_string(kHeight);
  write_file(raw, raw_pairs(3) + std::string(500, 'x'));  // ends inside a frame
  const auto exit_code_of = [&](const std::string& out, const std::string& is_waiting) {
    return shell("rm -f " + pipe + "; mkfifo " + pipe + "; " +
                 command(options("-", out,
                                 {"--raw-video", size, "--save", "preview", "--disparities=0:9",
                                  "--in-flight", "1"})) +
                 " <" + pipe + " >" + (folder_ / "stdout") + " & pid=$!; exec 3>" + pipe +
                 "; cat " + raw + " >&3; until " + is_waiting +
                 "; do sleep 0.02; done; kill -TERM $pid; (sleep 5; kill -KILL $pid) & wait $pid");
  };
  EXPECT_EQ(exit_code_of(out_, "[ -e " + out_ + "/preview/000002.png ]"), 130) << err();
  EXPECT_EQ(files_below(out_ + "/preview").size(), 3U);
  EXPECT_EQ(exit_code_of("-", "[ -s " + (folder_ / "stdout") + " ]"), 130) << err();
  // Before the first frame is complete.
  write_file(raw, "x");
  EXPECT_EQ(exit_code_of("-", "sleep 0.2"), 130) << err();
}

}  // namespace vantage::run_stream_folder_test
