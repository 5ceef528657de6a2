

#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage::video_reader_test {

/// RGB in 0..1 of luma and chroma, by the definition of the standards.
std::array<double, 3> rgb_of(const RawVideo& video, double luma, double blue, double red) {
  const bool high_definition = video.height >= 720;
  const double red_weight = high_definition ? 0.2126 : 0.299;
  const double blue_weight = high_definition ? 0.0722 : 0.114;
  const double unit = std::ldexp(1.0, video.bits - 8);
  const double white = std::ldexp(1.0, video.bits) - 1;
  const double y = video.full_range ? luma / white : (luma - 16 * unit) / (219 * unit);
  const double chroma_span = video.full_range ? white : 224 * unit;
  const double r = y + 2 * (1 - red_weight) * (red - 128 * unit) / chroma_span;
  const double b = y + 2 * (1 - blue_weight) * (blue - 128 * unit) / chroma_span;
  const double g = (y - red_weight * r - blue_weight * b) / (1 - red_weight - blue_weight);
  return {std::clamp(r, 0.0, 1.0), std::clamp(g, 0.0, 1.0), std::clamp(b, 0.0, 1.0)};
}

RawVideo random_video(const std::string& colours, int bits, bool full_range, int width, int height,
                      std::size_t planes) {
  RawVideo video{colours, bits, full_range, width, height, {}};
  std::mt19937 generator(7);
  video.frames.emplace_back(planes);
  for (auto& plane : video.frames[0]) {
    for (int i = 0; i < width * height; ++i) {
      plane.push_back(static_cast<int>(generator() >> (32 - bits)));
    }
  }
  return video;
}

template <typename T>
void expect_colours(const Photograph& photograph, const RawVideo& video) {
  ASSERT_TRUE(std::holds_alternative<Image<T>>(photograph.pixels));
  const auto& image = std::get<Image<T>>(photograph.pixels);
  ASSERT_EQ(image.channels(), 3);
  const auto& planes = video.frames[0];
  for (const auto [x, y] : positions_of(video.width, video.height)) {
    const auto i = static_cast<std::size_t>(y * video.width + x);
    const auto expected = rgb_of(video, planes[0][i], planes[1][i], planes[2][i]);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double value = expected.at(channel) * std::numeric_limits<T>::max();
      // Rounded, not cut off.
      ASSERT_NEAR(image.at(x, y, static_cast<int>(channel)), value, 0.53)
          << x << "," << y << " channel " << channel;
    }
  }
}

TEST(VideoReader, ConvertsColoursByTheDefinition) {
  const TemporaryFolder folder;
  for (const bool full_range : {false, true}) {
    for (const auto& [width, height] : {std::pair{37, 11}, std::pair{1, 1}, std::pair{6, 720}}) {
      SCOPED_TRACE(testing::Message() << width << "x" << height << " full " << full_range);
      Photograph frame;
      const RawVideo video = random_video("444", 8, full_range, width, height, 3);
      put_raw_video(folder / "8.y4m", video);
      VideoReader reader(folder / "8.y4m");
      ASSERT_TRUE(reader.read(frame));
      expect_colours<std::uint8_t>(frame, video);
      const RawVideo deep = random_video("444p10", 10, full_range, width, height, 3);
      put_raw_video(folder / "10.y4m", deep);
      VideoReader deep_reader(folder / "10.y4m");
      ASSERT_TRUE(deep_reader.read(frame));
      expect_colours<std::uint16_t>(frame, deep);
    }
  }
}

template <typename T>
void expect_grey_levels(const Photograph& photograph, const RawVideo& video) {
  ASSERT_TRUE(std::holds_alternative<Image<T>>(photograph.pixels));
  const auto& image = std::get<Image<T>>(photograph.pixels);
  ASSERT_EQ(image.channels(), 1);
  for (int i = 0; i < video.width * video.height; ++i) {
    const int sample = video.frames[0][0][static_cast<std::size_t>(i)];
    const double unit = std::ldexp(1.0, video.bits - 8);
    const double level = video.full_range ? sample / (std::ldexp(1.0, video.bits) - 1)
                                          : (sample - 16 * unit) / (219 * unit);
    EXPECT_NEAR(image.at(i % video.width, i / video.width),
                std::numeric_limits<T>::max() * std::clamp(level, 0.0, 1.0), 0.501);
  }
}

TEST(VideoReader, GreyStreamsHaveOneChannelOfTheFullRange) {
  const TemporaryFolder folder;
  for (const bool full_range : {false, true}) {
    Photograph frame;
    const RawVideo video = random_video("mono", 8, full_range, 29, 13, 1);
    put_raw_video(folder / "8.y4m", video);
    VideoReader reader(folder / "8.y4m");
    ASSERT_TRUE(reader.read(frame));
    expect_grey_levels<std::uint8_t>(frame, video);
    for (const int bits : {10, 12, 16}) {
      const RawVideo deep =
          random_video("mono" + std::to_string(bits), bits, full_range, 29, 13, 1);
      put_raw_video(folder / "deep.y4m", deep);
      VideoReader deep_reader(folder / "deep.y4m");
      ASSERT_TRUE(deep_reader.read(frame));
      expect_grey_levels<std::uint16_t>(frame, deep);
    }
  }
}

/// A ramp of chroma along x with the samples at even columns, as H.264 and MPEG-2 have them: the
/// interpolated value at each column tells where the reader takes them to be.
TEST(VideoReader, PutsChromaWhereItWasSampled) {
  const TemporaryFolder folder;
  constexpr int kWidth = 64;
  constexpr int kHeight = 16;
  RawVideo video{"420mpeg2", 8,       true,
                 kWidth,     kHeight, {{std::vector<int>(kWidth * kHeight, 128), {}, {}}}};
  for (int i = 0; i < kWidth / 2 * kHeight / 2; ++i) {
    video.frames[0][1].push_back(128);
    video.frames[0][2].push_back(96 + 2 * (i % (kWidth / 2)));
  }
  put_raw_video(folder / "a.y4m", video);
  VideoReader reader(folder / "a.y4m");
  Photograph frame;
  ASSERT_TRUE(reader.read(frame));
  const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
  for (int x = 8; x < kWidth - 8; ++x) {
    EXPECT_NEAR(image.at(x, 8, 0), rgb_of(video, 128, 128, 96 + x)[0] * 255, 1.0) << x;
  }
}

TEST(VideoReader, CountsFramesThatAreMissingByTheirTimes) {
  const TemporaryFolder folder;
  constexpr FrameRate kRate{10, 1};
  put_numbered_video(folder / "a.mp4", 12, kRate);
  const auto time_of = [](int frame) {
    return frame < 4 ? frame : frame < 9 ? frame + 1 : frame + 8;
  };
  for (const char* container : {"mp4", "matroska", "mov", "nut"}) {
    SCOPED_TRACE(container);
    remux_video(folder / "a.mp4", folder / "gaps", container, kRate, {}, time_of);
    VideoReader reader(folder / "gaps");
    EXPECT_EQ(reader.frame_count(), 12);
    ASSERT_TRUE(reader.frame_rate().has_value());
    EXPECT_NEAR(reader.frame_rate()->per_second(), 10, 0.2);
    std::vector<int> missing;
    Photograph frame;
    for (int i = 0; reader.read(frame); ++i) {
      EXPECT_EQ(number_of_frame(frame), i);
      missing.push_back(reader.frames_missing());
    }
    EXPECT_THAT(missing, ElementsAre(0, 0, 0, 0, 1, 0, 0, 0, 0, 7, 0, 0));
  }
}

TEST(VideoReader, CountsFramesAndKnowsTheRateInOtherContainers) {
  const TemporaryFolder folder;
  for (const FrameRate rate : {FrameRate{24, 1}, FrameRate{30000, 1001}, FrameRate{15, 2}}) {
    put_numbered_video(folder / "a.mp4", 21, rate);
    for (const char* container : {"matroska", "mpegts", "mov", "nut", "flv", "h264"}) {
      SCOPED_TRACE(container + (" " + to_string(rate)));
      ASSERT_NO_THROW(remux_video(folder / "a.mp4", folder / "b", container, rate));
      VideoReader reader(folder / "b");
      EXPECT_EQ(reader.frame_count(), 21);
      if (container != std::string("h264")) {
        ASSERT_TRUE(reader.frame_rate());
        EXPECT_NEAR(reader.frame_rate()->per_second() / rate.per_second(), 1, 1e-3);
      }
      EXPECT_EQ(frame_numbers(folder / "b").size(), 21U);
      EXPECT_EQ(frame_numbers(folder / "b").back(), 20);
    }
  }
}

TEST(VideoReader, ShowsWhatAnEditListShows) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 12, {10, 1});
  remux_video(folder / "a.mp4", folder / "b.mp4", "mp4", {10, 1}, {},
              [](int frame) { return frame - 3; });
  VideoReader reader(folder / "b.mp4");
  EXPECT_EQ(reader.frame_count(), 9);
  EXPECT_THAT(frame_numbers(folder / "b.mp4"), ElementsAre(3, 4, 5, 6, 7, 8, 9, 10, 11));
}

/// Frames before the damaged one are given out, and that one is named, whatever the threads.
TEST(VideoReader, OneDamagedPacketIsAnErrorAtItsFrame) {
  const TemporaryFolder folder;
  constexpr int kFrames = 24;
  put_numbered_video(folder / "a.mp4", kFrames, {25, 1});
  const std::vector<VideoPacket> packets = video_packets(folder / "a.mp4");
  ASSERT_EQ(packets.size(), static_cast<std::size_t>(kFrames));
  const auto whole = bytes_of(folder / "a.mp4");
  for (const std::size_t damaged : {0, 1, 7, 13, 23}) {
    // The length of the part that the packet begins with: no such part.
    auto bytes = whole;
    std::fill_n(bytes.begin() + packets[damaged].offset, 4, std::uint8_t{0xFF});
    put_bytes(folder / "b.mp4", bytes);
    int first_lost = kFrames;
    for (std::size_t i = damaged; i < packets.size(); ++i) {
      first_lost = std::min(first_lost, packets[i].frame);
    }
    testing::internal::CaptureStderr();
    VideoReader reader(folder / "b.mp4");
    Photograph frame;
    for (int i = 0; i < first_lost; ++i) {
      ASSERT_TRUE(reader.read(frame)) << damaged;
      EXPECT_EQ(number_of_frame(frame), i);
    }
    EXPECT_THAT(error_of([&] { reader.read(frame); }),
                AllOf(HasSubstr("b.mp4"), HasSubstr("frame " + std::to_string(first_lost) + " "),
                      HasSubstr("expected 24")));
    EXPECT_FALSE(reader.read(frame)) << "a video ends with its damage";
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

TEST(VideoReader, ASizeThatChangesIsAnErrorAtItsFrame) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> both;
  for (const int width : {64, 96}) {
    put_numbered_video(folder / "a.mp4", 5, {25, 1}, width);
    remux_video(folder / "a.mp4", folder / "a.ts", "mpegts", {25, 1});
    const auto bytes = bytes_of(folder / "a.ts");
    both.insert(both.end(), bytes.begin(), bytes.end());
  }
  put_bytes(folder / "both.ts", both);
  VideoReader reader(folder / "both.ts");
  Photograph frame;
  int frames = 0;
  const std::string error = error_of([&] {
    for (; reader.read(frame); ++frames) {
      EXPECT_EQ(frame.width(), 64);
    }
  });
  EXPECT_EQ(frames, 5);
  EXPECT_THAT(error, HasSubstr("frame 5 cannot be decoded (the size of the pictures changes there, "
                               "from 64x48 to 96x48)"));
}

TEST(VideoReader, AVideoCutWithoutEncodingIsAnErrorAndNotGrey) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 12, {25, 1});
  remux_video(
      folder / "a.mp4", folder / "b.mp4", "mp4", {25, 1}, {}, [](int frame) { return frame - 4; },
      [](int frame) { return frame >= 4; });
  const std::string error = error_of([&] { frame_numbers(folder / "b.mp4"); });
  EXPECT_THAT(error, AllOf(HasSubstr("b.mp4"), HasSubstr("frame 0")));
}

/// Cut at a frame to decode from, it begins with frames that cannot be decoded: those are left out,
/// the others are right.
TEST(VideoReader, AVideoCutAtAnOpenGroupBeginsWithItsFirstWholeFrame) {
  const TemporaryFolder folder;
  put_open_groups_video(folder / "a.mp4", 24, {10, 1});
  EXPECT_EQ(frame_numbers(folder / "a.mp4").size(), 24U);
  const std::vector<VideoPacket> packets = video_packets(folder / "a.mp4");
  const auto cut =
      std::find_if(packets.begin() + 1, packets.end(), [](const auto& p) { return p.key; });
  ASSERT_NE(cut, packets.end());
  const int first_whole = cut->frame;
  std::set<int> kept;
  std::for_each(cut, packets.end(), [&](const auto& packet) { kept.insert(packet.frame); });
  ASSERT_LT(*kept.begin(), first_whole) << "no frame is shown before the one to decode from";
  for (const char* container : {"matroska", "mp4"}) {
    SCOPED_TRACE(container);
    remux_video(
        folder / "a.mp4", folder / "b", container, {10, 1}, {},
        [&](int frame) { return frame - *kept.begin(); },
        [&](int frame) { return kept.contains(frame); });
    std::vector<int> expected;
    for (int i = first_whole; i < 24; ++i) {
      expected.push_back(i);
    }
    EXPECT_EQ(frame_numbers(folder / "b"), expected);
  }
  remux_video(
      folder / "a.mp4", folder / "b", "matroska", {10, 1}, {},
      [&](int frame) { return frame - *kept.begin(); },
      [&](int frame) { return kept.contains(frame); });
  EXPECT_EQ(VideoReader(folder / "b").frame_count(), 24 - first_whole);
}

TEST(VideoReader, OpensOnlyVideos) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 2, {25, 1});
  const std::string name = folder / "a.mp4";
  for (const std::string& text :
       {"ffconcat version 1.0\nfile " + name + "\n",
        "#EXTM3U\n#EXT-X-TARGETDURATION:10\n#EXTINF:1,\n" + name + "\n#EXT-X-ENDLIST\n",
        std::string("plain text in a file that is called so\n")}) {
    for (const char* file : {"list.txt", "list.m3u8", "list.mp4"}) {
      put_text(folder / file, text);
      EXPECT_THAT(error_of([&] { VideoReader(folder / file); }), HasSubstr("not a video")) << text;
    }
  }
}

TEST(VideoReader, RefusesAbsurdSizes) {
  const TemporaryFolder folder;
  put_text(folder / "a.y4m", "YUV4MPEG2 W60000 H60000 F25:1 C444\nFRAME\nxxxx");
  EXPECT_THAT(error_of([&] { VideoReader(folder / "a.y4m"); }), HasSubstr("a.y4m"));
}

/// Codecs of old games are not opened, whatever a file calls its frames; those of recorders of
/// screens and of capture cards are.
TEST(VideoReader, ReadsFootageOnly) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "film.mp4", 2, {25, 1});
  const auto problem_of = [&](AVCodecID codec) {
    put_tracks({folder / "film.mp4"}, folder / "a.avi", "avi", [&](AVStream& stream, int) {
      stream.codecpar->codec_id = codec;
      stream.codecpar->codec_tag = 0;
    });
    return error_of([&] { VideoReader(folder / "a.avi"); });
  };
  EXPECT_THAT(problem_of(AV_CODEC_ID_MSVIDEO1),
              HasSubstr("a.avi: its codec msvideo1 is none that footage uses"));
  for (const AVCodecID codec : {AV_CODEC_ID_FRAPS, AV_CODEC_ID_ZMBV, AV_CODEC_ID_V210X}) {
    EXPECT_THAT(problem_of(codec), Not(HasSubstr("footage"))) << codec;
  }
}

}  // namespace vantage::video_reader_test
