// Times of the frames of films with a variable rate.

#include <array>
#include <cstdint>

#include "engine/io/video/libav.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/writing/video_join.h"
#include "tests/apps/stream_fixture.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage::run_film_times_test {

constexpr int kFilm = 12;
const FrameRate kFilmRate{24000, 1001};

/// When the packets of a video are shown, in seconds, in order, as libavformat reads them.
std::vector<double> packet_times(const fs::path& path) {
  const LibavInput input = open_media_file(path);
  const AVStream& stream = *find_video_stream(*input);
  const LibavPacket packet = make_libav_packet();
  std::vector<double> times;
  while (libav().av_read_frame(input.get(), packet.get()) >= 0) {
    if (packet->stream_index == stream.index) {
      times.push_back(static_cast<double>(packet->pts) * av_q2d(stream.time_base));
    }
    libav().av_packet_unref(packet.get());
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// A film whose every fourth frame is shown five times as long as the others.
class RunFilmTimes : public StreamTest {
 protected:
  RunFilmTimes() {
    const ProcessResult made = succeeds(run(
        folder_ / "made",
        words(
            "--frames 0-11 --save stereo --video stereo --stereo-packing sbsl --fps 24000/1001")));
    for (int frame = 0; frame <= kFilm; ++frame) {
      times_.times.push_back(frame == 0 ? 0
                                        : times_.times.back() + 1001 * (frame % 4 == 0 ? 5 : 1));
    }
    const std::array<fs::path, 1> film = {folder_ / "made/stereo.mp4"};
    join_videos(film, kFilmRate, {}, film_, times_);
  }
  [[nodiscard]] Words arguments_for(const std::string& out, const Words& more) const {
    return joined(
        {"run", "--stereo", film_, "--packing", "sbsl", "--method", "ssd", "--disparities=0:9",
         "--chunk-frames", "5", "-o", out, "--save", "depth-video,preview", "--video", "preview"},
        more);
  }
  /// Returns the folder.
  [[nodiscard]] std::string process(const Words& more) const {
    const std::string out = folder_ / "out";
    succeeds(run_vantage(joined(arguments_for(out, more), {"--overwrite"})));
    return out;
  }
  /// Of frame `first` of the film and every `step`-th after it, from the first on.
  static void expect_times(const std::string& video, int first, int count, int step,
                           double tolerance_seconds) {
    const std::vector<double> found = packet_times(video);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(count)) << video;
    const auto due = [&](int frame) { return 1001.0 / 24000 * (frame + frame / 4 * 4); };
    for (int i = 0; i < count; ++i) {
      EXPECT_NEAR(found[i] - found[0], due(first + i * step) - due(first), tolerance_seconds)
          << video << " " << i;
    }
  }

  static constexpr double kExact = 1e-9;
  static constexpr double kMatroska = 0.001;  // two rounded times
  FrameTimes times_{{}, 1, 24000, kFilmRate};
  std::string film_ = folder_ / "film.mp4";
};

TEST_F(RunFilmTimes, AreThoseOfTheSelectedFrames) {
  expect_times(film_, 0, kFilm, 1, kExact);
  const std::string out = process({});
  expect_times(out + "/preview.mp4", 0, kFilm, 1, kExact);
  expect_times(out + "/depth-video.mkv", 0, kFilm, 1, kMatroska);
  (void)process({"--depth-codec", "prores-10", "--frames", "2-9"});
  expect_times(out + "/preview.mp4", 2, 8, 1, kExact);
  expect_times(out + "/depth-video.mov", 2, 8, 1, kExact);
  (void)process({"--every", "3+1"});
  expect_times(out + "/preview.mp4", 1, 4, 3, kExact);
  expect_times(out + "/depth-video.mkv", 1, 4, 3, kMatroska);
}

TEST_F(RunFilmTimes, AreTheSameForPartsOfARun) {
  const FolderContent whole = results_in(process({}));
  const std::string out = folder_ / "parts";
  for (const char* shard : {"2/2", "1/2"}) {
    succeeds(run_vantage(arguments_for(out, {"--shard", shard})));
  }
  fs::rename(film_, folder_ / "elsewhere.mp4");
  succeeds(run_vantage({"merge", out, "--no-sound"}));
  expect_times(out + "/preview.mp4", 0, kFilm, 1, kExact);
  EXPECT_TRUE(same_files(results_in(out), whole));
}

TEST_F(RunFilmTimes, GiveWayToAnotherRate) {
  const std::vector<double> found = packet_times(process({"--fps", "25"}) + "/preview.mp4");
  ASSERT_EQ(found.size(), static_cast<std::size_t>(kFilm));
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_NEAR(found[i] - found[i - 1], 0.04, kExact);
  }
}

TEST_F(RunFilmTimes, CannotBeInAStream) {
  const Words stream = {"--frames", "0-1", "--save", "preview", "-o", "-"};
  const Words input = {"--stereo", film_, "--packing",        "sbsl",
                       "--method", "ssd", "--disparities=0:9"};
  ASSERT_EQ(shell(command(joined(input, stream)) + " >" + (folder_ / "out.y4m")), 0) << err();
  EXPECT_THAT(err(), HasSubstr("run: warning: the input has a variable frame rate"));
  ASSERT_EQ(
      shell(command(joined(joined(input, stream), {"--fps", "25"})) + " >" + (folder_ / "out.y4m")),
      0)
      << err();
  EXPECT_THAT(err(), Not(HasSubstr("variable")));
}

}  // namespace vantage::run_film_times_test
