#include "engine/io/video/video_io.h"

#include <sys/resource.h>

#include <csignal>

#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"
#include "tests/test_paths.h"

namespace vantage::video_io_test {

/// Left half (200, 60, 30), right half (30, 90, 220); a white square that moves with the frame.
Photograph test_frame(int width, int height, int index) {
  Image<std::uint8_t> image(width, height, 3);
  for (const auto [x, y] : positions_of(width, height)) {
    const bool left = x < width / 2;
    const bool square = y < 8 && x / 8 == index;
    const int colour[3] = {left ? 200 : 30, left ? 60 : 90, left ? 30 : 220};
    for (int channel = 0; channel < 3; ++channel) {
      image.at(x, y, channel) = static_cast<std::uint8_t>(square ? 255 : colour[channel]);
    }
  }
  return {std::move(image)};
}

void write_video(const std::filesystem::path& path, int width, int height, int frames,
                 FrameRate rate = {}) {
  VideoWriter writer(path, width, height, {.rate = rate});
  for (int i = 0; i < frames; ++i) {
    writer.write(test_frame(width, height, i));
  }
  writer.finish();
}

TEST(VideoIo, ReadsBackCountRateColoursAndOrder) {
  const TemporaryFolder folder;
  write_video(folder / "a.mp4", 96, 64, 11, {25, 2});
  EXPECT_EQ(folder.entries(), 1U);
  VideoReader reader(folder / "a.mp4");
  EXPECT_EQ(reader.width(), 96);
  EXPECT_EQ(reader.height(), 64);
  EXPECT_EQ(reader.frame_count(), 11);
  EXPECT_EQ(reader.frame_rate(), (FrameRate{25, 2}));
  Photograph frame;
  for (int i = 0; i < 11; ++i) {
    ASSERT_TRUE(reader.read(frame));
    const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
    const Photograph expected_frame = test_frame(96, 64, i);
    const auto& expected = std::get<Image<std::uint8_t>>(expected_frame.pixels);
    for (const auto& [x, y] : {std::pair{20, 40}, std::pair{80, 40}, std::pair{8 * i + 4, 3}}) {
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(image.at(x, y, channel), expected.at(x, y, channel), 14)
            << "frame " << i << " " << x << "," << y << " channel " << channel;
      }
    }
  }
  EXPECT_FALSE(reader.read(frame));
  EXPECT_FALSE(reader.read(frame));
}

TEST(VideoIo, FramesSayHowTheyWereQuantised) {
  const TemporaryFolder folder;
  const auto coding_at = [&](VideoEncoding encoding, const char* name) {
    VideoWriter writer(folder / name, 64, 32, encoding);
    for (unsigned i = 0; i < 3; ++i) {
      writer.write(noise<std::uint8_t>(64, 32, encoding.coding == VideoCoding::kH264 ? 3 : 1, i));
    }
    writer.finish();
    Photograph frame;
    frame.origin.coding = LossyCoding{.codec = "of another"};
    VideoReader(folder / name).read(frame);
    return frame.origin.coding;
  };
  // Six more of CRF, and so of QP, double the step.
  const LossyCoding fine = coding_at({.crf = 20}, "fine.mp4").value();
  const LossyCoding coarse = coding_at({.crf = 32}, "coarse.mp4").value();
  EXPECT_EQ(fine.codec, "h264");
  EXPECT_NEAR(coarse.step_grey_levels / fine.step_grey_levels, 4, 1);
  // CRF is the QP of pictures of usual complexity; of noise the encoder makes it larger.
  EXPECT_GT(fine.step_grey_levels, std::exp2((20 - 4 - 6) / 6.0));
  EXPECT_LT(fine.step_grey_levels, std::exp2((20 - 4 + 12) / 6.0));
}

TEST(VideoIo, ReusesTheMemoryOfTheFrame) {
  const TemporaryFolder folder;
  write_video(folder / "a.mp4", 32, 32, 3);
  VideoReader reader(folder / "a.mp4");
  Photograph frame;
  ASSERT_TRUE(reader.read(frame));
  const auto* pixels = std::get<Image<std::uint8_t>>(frame.pixels).row(0);
  ASSERT_TRUE(reader.read(frame));
  EXPECT_EQ(std::get<Image<std::uint8_t>>(frame.pixels).row(0), pixels);
}

TEST(VideoIo, OddSizesArePaddedByTheirLastColumnAndRow) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{33, 47}, std::pair{35, 2}, std::pair{3, 3}}) {
    write_video(folder / "a.mp4", width, height, 2);
    VideoReader reader(folder / "a.mp4");
    EXPECT_EQ(reader.width(), (width + 1) / 2 * 2);
    EXPECT_EQ(reader.height(), (height + 1) / 2 * 2);
    Photograph frame;
    ASSERT_TRUE(reader.read(frame));
    const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
    const int last = image.width() - 1;
    const int bottom = image.height() - 1;
    EXPECT_NEAR(image.at(last, bottom, 2), height == 47 ? 220 : image.at(last - 1, bottom, 2), 14);
  }
}

/// Coding and the conversion to YUV and back cost a flat grey up to 5 levels.
TEST(VideoIo, TakesEveryDepthAndChannelCount) {
  const TemporaryFolder folder;
  Photograph grey{Image<std::uint8_t>(16, 16, 1)};
  std::get<Image<std::uint8_t>>(grey.pixels).fill(100);
  Photograph wide{Image<std::uint16_t>(16, 16, 4)};
  std::get<Image<std::uint16_t>>(wide.pixels).fill(100 * 257);
  Photograph real{Image<float>(16, 16, 3)};
  std::get<Image<float>>(real.pixels).fill(100.0F / 255);
  Photograph bright{Image<float>(16, 16, 1)};
  std::get<Image<float>>(bright.pixels).fill(7.0F);
  VideoWriter writer(folder / "a.mp4", 16, 16, {});
  for (const Photograph* frame : {&grey, &wide, &real, &bright}) {
    writer.write(*frame);
  }
  writer.finish();
  VideoReader reader(folder / "a.mp4");
  Photograph frame;
  for (const int expected : {100, 100, 100, 255}) {
    ASSERT_TRUE(reader.read(frame));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(std::get<Image<std::uint8_t>>(frame.pixels).at(8, 8, channel), expected, 6);
    }
  }
}

/// Smooth colours come back as they were but for coding: matrix, range and place of chroma agree.
TEST(VideoIo, GradientsSurviveClosely) {
  const TemporaryFolder folder;
  Photograph gradient{Image<std::uint8_t>(96, 64, 3)};
  auto& image = std::get<Image<std::uint8_t>>(gradient.pixels);
  for (const auto [x, y] : positions_of(96, 64)) {
    image.at(x, y, 0) = static_cast<std::uint8_t>(40 + 2 * x);
    image.at(x, y, 1) = static_cast<std::uint8_t>(30 + 3 * y);
    image.at(x, y, 2) = static_cast<std::uint8_t>(220 - x - y);
  }
  VideoWriter writer(folder / "a.mp4", 96, 64, {.rate = {}, .crf = 0});
  writer.write(gradient);
  writer.finish();
  VideoReader reader(folder / "a.mp4");
  Photograph frame;
  ASSERT_TRUE(reader.read(frame));
  double squares = 0;
  double sum = 0;
  for (const auto [i, y] : positions_of(3 * 96, 64)) {
    const double difference =
        std::get<Image<std::uint8_t>>(frame.pixels).row(y)[i] - image.row(y)[i];
    EXPECT_LE(std::abs(difference), 4) << i / 3 << "," << y << " channel " << i % 3;
    squares += difference * difference;
    sum += difference;
  }
  EXPECT_LT(std::sqrt(squares / (64 * 3 * 96)), 0.9);
  EXPECT_LT(std::abs(sum / (64 * 3 * 96)), 0.1);
}

TEST(VideoIo, BytesDependOnTheFramesOnly) {
  const TemporaryFolder folder;
  for (const char* name : {"a.mp4", "b.mp4"}) {
    put_numbered_video(folder / name, 20, {30000, 1001});
  }
  EXPECT_EQ(bytes_of(folder / "a.mp4"), bytes_of(folder / "b.mp4"));
}

/// Files may not become longer than a limit: as on a full disk, but for the number of the error.
TEST(VideoIo, AFullDiskIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto write = [&] {
    VideoWriter writer(folder / "a.mp4", 96, 64, {.rate = {}, .crf = 0});
    for (unsigned i = 0; i < 6; ++i) {
      writer.write(noise<std::uint8_t>(96, 64, 3, i));
    }
    writer.finish();
  };
  write();
  const std::size_t whole = bytes_of(folder / "a.mp4").size();
  std::filesystem::remove(folder / "a.mp4");
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  for (const std::size_t bytes : {std::size_t{20}, whole / 3, whole - 1000, whole - 1}) {
    const rlimit limit{bytes, old_limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const std::string error = error_of(write);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old_limit), 0);
    EXPECT_THAT(error, testing::AllOf(HasSubstr("cannot write"), HasSubstr("a.mp4"))) << bytes;
    EXPECT_EQ(folder.entries(), 0U) << bytes << " of " << whole;
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST(VideoIo, IsH264In420InMp4) {
  const TemporaryFolder folder;
  write_video(folder / "a.mp4", 32, 32, 2);
  const auto bytes = bytes_of(folder / "a.mp4");
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_EQ(text.substr(4, 4), "ftyp");
  EXPECT_EQ(text.find("Lavf"), std::string::npos) << "the version of a library";
  const std::size_t configuration = text.find("avcC");
  ASSERT_NE(configuration, std::string::npos);
  // Of the profiles of H.264, 66, 77 and 100 have 4:2:0 only with 8 bits: what browsers play.
  const int profile = static_cast<unsigned char>(text[configuration + 5]);
  EXPECT_TRUE(profile == 66 || profile == 77 || profile == 100) << profile;
}

TEST(VideoIo, FinishOnlyNamesWhatHasBeenEncodedBefore) {
  const TemporaryFolder folder;
  write_video(folder / "a.mp4", 32, 32, 60);
  VideoWriter writer(folder / "b.mp4", 32, 32, {});
  for (int i = 0; i < 60; ++i) {
    writer.write(test_frame(32, 32, i));
  }
  writer.end();
  EXPECT_EQ(folder.entries(), 2U);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.mp4"));
  writer.finish();
  EXPECT_EQ(bytes_of(folder / "b.mp4"), bytes_of(folder / "a.mp4"));
}

TEST(VideoIo, NothingIsLeftWithoutFinish) {
  const TemporaryFolder folder;
  put_text(folder / "a.mp4", "old");
  {
    VideoWriter writer(folder / "a.mp4", 32, 32, {});
    writer.write(test_frame(32, 32, 0));
  }
  EXPECT_EQ(folder.entries(), 1U);
  EXPECT_EQ(bytes_of(folder / "a.mp4").size(), 3U);
  {
    VideoWriter writer(folder / "b.mp4", 32, 32, {});
    EXPECT_THAT(error_of([&] { writer.finish(); }), HasSubstr("no frames"));
  }
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(VideoIo, WriterRefusesBadNamesSizesRatesAndFrames) {
  const TemporaryFolder folder;
  const auto refuses = [&](const char* name, int width, int height, VideoEncoding encoding = {}) {
    EXPECT_THROW(VideoWriter(folder / name, width, height, encoding), UsageError)
        << name << " " << width << "x" << height;
  };
  refuses("a.avi", 32, 32);
  refuses("a.mp4", 1, 32);
  refuses("a.mp4", 32, 20000);
  refuses("a.mp4", 32, 32, {.rate = {0, 1}});
  refuses("a.mp4", 32, 32, {.rate = {25, 0}});
  refuses("a.mp4", 32, 32, {.rate = {1001, 1}});
  refuses("a.mp4", 32, 32, {.rate = {2'000'000, 1'000'000}});
  refuses("a.mp4", 32, 32, {.crf = -1});
  refuses("a.mp4", 32, 32, {.crf = 52});
  EXPECT_THAT(error_of([&] { VideoWriter(folder / "no/a.mp4", 32, 32, {}); }),
              HasSubstr("no folder"));
  VideoWriter writer(folder / "a.mp4", 32, 32, {});
  EXPECT_THAT(error_of([&] { writer.write(test_frame(32, 30, 0)); }),
              testing::AllOf(HasSubstr("32x30"), HasSubstr("32x32")));
}

TEST(VideoIo, ReaderRefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { VideoReader(folder / "no.mp4"); }), HasSubstr("no such file"));
  EXPECT_THAT(error_of([&] { VideoReader(folder.path()); }), HasSubstr("video file"));
  put_text(folder / "a.mp4", "");
  EXPECT_THAT(error_of([&] { VideoReader(folder / "a.mp4"); }), HasSubstr("empty"));
  put_text(folder / "a.mp4", "this is text, and long enough to look at\n");
  EXPECT_THAT(error_of([&] { VideoReader(folder / "a.mp4"); }), HasSubstr("not a video"));
}

TEST(VideoIo, ReadsTheSharedVideoWhichShowsTheSharedFrames) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::is_directory(data / "kitti_seq1")) {
    GTEST_SKIP() << "no video at " << data / "kitti_seq1";
  }
  VideoReader reader(data / "kitti_seq1/kitti_seq1_sbs.mp4");
  EXPECT_EQ(reader.width(), 2452);
  EXPECT_EQ(reader.height(), 370);
  EXPECT_EQ(reader.frame_count(), 51);
  EXPECT_EQ(reader.frame_rate(), (FrameRate{10, 1}));
  Photograph frame;
  int frames = 0;
  while (reader.read(frame)) {
    if (frames == 35) {
      const Photograph left = read_photograph(data / "kitti_seq1/left/000035.png");
      const auto& expected = std::get<Image<std::uint8_t>>(left.pixels);
      const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
      for (int channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (const auto [x, y] : positions_of(expected)) {
          sum += std::abs(image.at(x, y, channel) - expected.at(x, y));
        }
        EXPECT_LT(sum / (expected.width() * expected.height()), 3) << channel;
      }
    }
    ++frames;
  }
  EXPECT_EQ(frames, 51);
}

}  // namespace vantage::video_io_test
