// Groups of pictures that are encoded side by side: the file is the same, whoever encodes them.

#include <atomic>
#include <thread>

#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"
#include "tests/test_paths.h"

namespace vantage::video_groups_test {

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr int kNumbers = 24;  // that a coding keeps apart

Photograph frame_of(VideoCoding coding, int index) {
  Photograph frame = numbered_frame(kWidth, kHeight, index % kNumbers);
  if (is_grey(coding)) {
    const auto& colours = std::get<Image<std::uint8_t>>(frame.pixels);
    Image<std::uint16_t> grey(kWidth, kHeight, 1);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      grey.at(x, y) = static_cast<std::uint16_t>(257 * colours.at(x, y, 0));
    }
    frame.pixels = std::move(grey);
  }
  return frame;
}

int number_in(const Photograph& frame) {
  Photograph eight_bits{Image<std::uint8_t>(frame.width(), frame.height(), frame.channels())};
  if (const auto* wide = std::get_if<Image<std::uint16_t>>(&frame.pixels)) {
    auto& image = std::get<Image<std::uint8_t>>(eight_bits.pixels);
    for (const auto [x, y] : positions_of(frame.width() * frame.channels(), frame.height())) {
      image.row(y)[x] = static_cast<std::uint8_t>(wide->row(y)[x] / 257);
    }
    return number_of_frame(eight_bits);
  }
  return number_of_frame(frame);
}

/// The frames one after the other on this thread, or added for so many others.
void write_video(const std::filesystem::path& path, VideoCoding coding, int frames, int threads) {
  VideoWriter writer(path, kWidth, kHeight, {.rate = {30, 1}, .crf = 18, .coding = coding});
  if (threads == 0) {
    for (int i = 0; i < frames; ++i) {
      writer.write(frame_of(coding, i));
    }
    writer.finish();
    return;
  }
  std::atomic<bool> ended{false};
  {
    std::vector<std::jthread> encoders;
    for (int i = 0; i < threads; ++i) {
      encoders.emplace_back([&] {
        while (!ended) {
          if (!writer.encode_some()) {
            std::this_thread::yield();
          }
        }
      });
    }
    const FrameConversion convert = make_frame_conversion(coding, kWidth, kHeight);
    for (int i = 0; i < frames; ++i) {
      writer.add(convert(frame_of(coding, i)));
    }
    writer.finish();
    ended = true;
  }
}

TEST(VideoGroups, BytesDoNotDependOnWhoEncodes) {
  const TemporaryFolder folder;
  for (const auto& [coding, frames] :
       {std::pair{VideoCoding::kH264, 2 * 50 + 1}, std::pair{VideoCoding::kHevcColours_10, 53},
        std::pair{VideoCoding::kFfv1_16, 7}, std::pair{VideoCoding::kHuffYuv_16, 7},
        std::pair{VideoCoding::kProRes_10, 7}}) {
    const VideoCodingTraits& traits = traits_of(coding);
    const auto path = [&, extension = traits.extension](const std::string& name) {
      return folder / (name + "." + std::string(extension));
    };
    write_video(path("alone"), coding, frames, 0);
    for (const int threads : {1, 3}) {
      write_video(path("threads"), coding, frames, threads);
      EXPECT_EQ(bytes_of(path("threads")), bytes_of(path("alone"))) << traits.name;
    }
    VideoReader reader(path("alone"));
    Photograph frame;
    for (int i = 0; i < frames; ++i) {
      ASSERT_TRUE(reader.read(frame)) << traits.name << " " << i;
      EXPECT_EQ(number_in(frame), i % kNumbers) << traits.name << " " << i;
    }
    EXPECT_FALSE(reader.read(frame));
  }
}

// The threads of a run leave when its last frame is done; who finishes the file does what is left.
TEST(VideoGroups, FinishingGoesOnWhereOthersLeaveAGroup) {
  const TemporaryFolder folder;
  const FrameConversion convert = make_frame_conversion(VideoCoding::kH264, kWidth, kHeight);
  for (int round = 0; round < 10; ++round) {
    VideoWriter writer(folder / "left.mp4", kWidth, kHeight, {});
    for (int i = 0; i < 20; ++i) {
      writer.add(convert(frame_of(VideoCoding::kH264, i)));
    }
    std::atomic<bool> has_begun{false};
    const std::jthread leaving([&] {
      for (int part = 0; part < 5; ++part) {
        writer.encode_some();
        has_begun = true;
      }
    });
    while (!has_begun) {
      std::this_thread::yield();
    }
    writer.finish();
    VideoReader reader(folder / "left.mp4");
    Photograph frame;
    int frames = 0;
    while (reader.read(frame)) {
      ++frames;
    }
    EXPECT_EQ(frames, 20) << "round " << round;
  }
}

TEST(VideoGroups, EachStartsWithAKeyFrameAndTimesGoOn) {
  const TemporaryFolder folder;
  constexpr int kFrames = 123;
  write_video(folder / "a.mp4", VideoCoding::kH264, kFrames, 0);
  const LibavInput input = open_media_file(folder / "a.mp4");
  const AVStream& stream = *find_video_stream(*input);
  const LibavPacket packet = make_libav_packet();
  std::vector<std::int64_t> shown;
  std::int64_t decoded = -100;
  for (; libav().av_read_frame(input.get(), packet.get()) >= 0;
       libav().av_packet_unref(packet.get())) {
    const auto frame_of_time = [&](std::int64_t time) {
      return av_rescale_q(time, stream.time_base, {1, 30});
    };
    if (shown.size() % 50 == 0) {
      // Closed: all frames before it are before it in the file, too.
      EXPECT_NE(packet->flags & AV_PKT_FLAG_KEY, 0) << shown.size();
      EXPECT_EQ(frame_of_time(packet->pts), std::ssize(shown));
    }
    if (!shown.empty()) {
      EXPECT_EQ(frame_of_time(packet->dts), decoded + 1);
    }
    EXPECT_LE(packet->dts, packet->pts);
    decoded = frame_of_time(packet->dts);
    shown.push_back(frame_of_time(packet->pts));
  }
  std::ranges::sort(shown);
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(shown.at(static_cast<std::size_t>(i)), i);
  }
}

TEST(VideoGroups, WaitUntilTheyAreEncoded) {
  const TemporaryFolder folder;
  VideoWriter writer(folder / "a.mp4", kWidth, kHeight, {});
  EXPECT_FALSE(writer.encode_some());
  const FrameConversion convert = make_frame_conversion(VideoCoding::kH264, kWidth, kHeight);
  for (int i = 0; i < 3; ++i) {
    writer.add(convert(frame_of(VideoCoding::kH264, i)));
  }
  EXPECT_EQ(writer.frames_waiting(), 3);
  EXPECT_TRUE(writer.encode_some());
  EXPECT_EQ(writer.frames_waiting(), 2);
  writer.end();
  while (writer.encode_some()) {
  }
  EXPECT_EQ(writer.frames_waiting(), 0);
  writer.finish();
  EXPECT_THAT(frame_numbers(folder / "a.mp4"), testing::ElementsAre(0, 1, 2));
}

}  // namespace vantage::video_groups_test
