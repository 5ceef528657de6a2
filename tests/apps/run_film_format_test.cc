// What a film states of its pictures, in what a run writes.

#include "engine/io/video/video_io.h"
#include "tests/apps/stream_fixture.h"

namespace vantage::run_film_format_test {

class RunFilmFormats : public StreamTest {
 protected:
  /// The first frames, packed, of 16 bits.
  void write_film(const std::string& path, const FilmFormat& format) const {
    VideoWriter writer(
        path, 2 * kWidth, kHeight,
        {.rate = {}, .crf = 10, .coding = VideoCoding::kHevcColours_10, .format = format});
    for (int i = 0; i < 6; ++i) {
      Photograph packed;
      pack_stereo(read_photograph(left_ + "/" + frame_file(i)),
                  read_photograph(right_ + "/" + frame_file(i)), {}, packed);
      writer.write(packed);
    }
    writer.finish();
  }
  [[nodiscard]] static FilmFormat format_of(const std::string& path) {
    return VideoReader(path).film_format();
  }
};

TEST_F(RunFilmFormats, AreKeptByWhatShowsTheFilm) {
  // PQ of BT.2020.
  const FilmFormat format = {.pixel_aspect = {4, 3},
                             .colours = {.primaries = 9, .transfer = 16, .matrix = 9, .bits = 10}};
  const std::string film = folder_ / "film.mp4";
  const std::string out = folder_ / "out";
  write_film(film, format);
  const Words input = {"--stereo", film,  "--packing", "sbsl", "--disparities=0:9",
                       "--method", "ssd", "--view",    "0.5"};
  ASSERT_EQ(shell(command(joined(input, words("--save views,stereo,preview,depth-video "
                                              "--stereo-packing sbs2l --video views,stereo,preview "
                                              "--chunk-frames 5 -o " +
                                              out)))),
            0)
      << err();
  EXPECT_THAT(
      err(),
      HasSubstr(
          "pixels 4:3, 10 bits, primaries bt2020, transfer smpte2084, matrix "
          "bt2020nc: matched as it is coded; videos of views state the same (HEVC, 10 bits)"));
  EXPECT_EQ(format_of(out + "/views.mp4"), format);
  EXPECT_EQ(format_of(out + "/stereo.mp4"), format);
  const FilmFormat preview = {.pixel_aspect = {4, 3},
                              .colours = {.primaries = 1, .transfer = 1, .matrix = 1}};
  EXPECT_EQ(format_of(out + "/preview.mp4"), preview);
  EXPECT_EQ(format_of(out + "/depth-video.mkv").pixel_aspect, format.pixel_aspect);
  const std::string y4m = folder_ / "views.y4m";
  ASSERT_EQ(shell(command(joined(input, words("--save views -o -"))) + " >" + y4m), 0) << err();
  EXPECT_THAT(read_file(y4m), testing::StartsWith("YUV4MPEG2 W64 H48 F25:1 Ip A4:3 C420p10 "
                                                  "XYSCSS=420P10 XCOLORRANGE=LIMITED\n"));
}

}  // namespace vantage::run_film_format_test
