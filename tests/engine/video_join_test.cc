#include "engine/io/video/writing/video_join.h"

extern "C" {
#include <libavformat/avformat.h>
}

#include "engine/io/video/libav.h"
#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

namespace vantage::video_join_test {

constexpr FrameRate kRate{10, 1};

/// One video per count of frames; the numbers of their frames go on from one to the next.
std::vector<std::filesystem::path> put_segments(const TemporaryFolder& folder,
                                                const std::vector<int>& frame_counts,
                                                FrameRate rate = kRate) {
  std::vector<std::filesystem::path> paths;
  int number = 0;
  for (const int frames : frame_counts) {
    paths.push_back(folder / ("segment" + std::to_string(paths.size()) + ".mp4"));
    put_numbered_video(paths.back(), frames, rate, 64, 48, number);
    number += frames;
  }
  return paths;
}

std::vector<int> numbers_up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// A tone that rises from 200 to 1400 Hz in four seconds: each moment is unlike the others.
Sound rising_tone(double seconds, int samples_per_second) {
  Sound sound{samples_per_second, {}};
  for (int i = 0; i < static_cast<int>(seconds * samples_per_second); ++i) {
    const double t = static_cast<double>(i) / samples_per_second;
    sound.samples.push_back(
        static_cast<float>(0.5 * std::sin(2 * std::numbers::pi * (200 * t + 150 * t * t))));
  }
  return sound;
}

/// By how many samples `sound` comes later than `expected` from its sample `begin` on.
int delay_of(const Sound& sound, const Sound& expected, int begin) {
  int best_delay = 0;
  double best = -1;
  for (int delay = -100; delay <= 100; ++delay) {
    double product = 0;
    for (int i = 2000; i < 12000; ++i) {
      product += sound.samples.at(static_cast<std::size_t>(i)) *
                 expected.samples.at(static_cast<std::size_t>(begin + i - delay));
    }
    if (product > best) {
      best = product;
      best_delay = delay;
    }
  }
  return best_delay;
}

/// Four seconds of video with 16 kHz sound of `seconds`.
std::filesystem::path put_sounding_video(const TemporaryFolder& folder, double seconds = 4) {
  put_numbered_video(folder / "silent.mp4", 26, {13, 2});
  remux_video(folder / "silent.mp4", folder / "sounding.mkv", "matroska", {13, 2},
              rising_tone(seconds, 16000));
  return folder / "sounding.mkv";
}

TEST(VideoJoin, HoldsTheFramesOfAllSegmentsInOrderAtExactTimes) {
  const TemporaryFolder folder;
  for (const FrameRate rate : {kRate, FrameRate{30000, 1001}}) {
    for (const std::vector<int>& counts :
         {std::vector{5}, {1}, {1, 1}, {3, 1, 2, 1, 7}, {2, 8}, {8, 2}}) {
      join_videos(put_segments(folder, counts, rate), rate, {}, folder / "joined.mp4");
      const int frames = std::accumulate(counts.begin(), counts.end(), 0);
      EXPECT_EQ(frame_numbers(folder / "joined.mp4"), numbers_up_to(frames));
      VideoReader reader(folder / "joined.mp4");
      EXPECT_EQ(reader.frame_count(), frames);
      EXPECT_EQ(reader.frame_rate(), rate);
      for (int i = 0; i < frames; ++i) {
        ASSERT_TRUE(reader.skip());
        EXPECT_EQ(reader.frames_missing(), 0);
      }
    }
  }
  EXPECT_EQ(sound_codec(folder / "joined.mp4"), "");
}

TEST(VideoJoin, KeepsTheTimesOfAVariableRate) {
  const TemporaryFolder folder;
  FrameTimes times{
      {700, 1701, 2702, 5705, 6706, 12712, 13713, 14714, 15715, 20720, 25725}, 1, 24000, {8, 1}};
  const auto segments = put_segments(folder, {4, 6}, times.rate);
  join_videos(segments, times.rate, {}, folder / "joined.mp4", times);
  EXPECT_EQ(frame_numbers(folder / "joined.mp4"), numbers_up_to(10));
  const auto joined = VideoReader(folder / "joined.mp4").frame_times();
  ASSERT_TRUE(joined);
  ASSERT_EQ(joined->times.size(), times.times.size());
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(joined->seconds(i), times.seconds(i) - times.seconds(0), 1e-9) << i;
  }
  times.times.pop_back();
  EXPECT_THAT(error_of([&] { join_videos(segments, times.rate, {}, folder / "few.mp4", times); }),
              HasSubstr("has 10 frames, expected the 9"));
  join_videos(segments, times.rate, {}, folder / "even.mp4");
  EXPECT_FALSE(VideoReader(folder / "even.mp4").frame_times());
}

TEST(VideoJoin, BytesDependOnTheInputsOnly) {
  const TemporaryFolder folder;
  const auto segments = put_segments(folder, {4, 6});
  const SoundTrack sound{put_sounding_video(folder), 0.5, 1.5};
  join_videos(segments, kRate, sound, folder / "a.mp4");
  join_videos(segments, kRate, sound, folder / "b.mp4");
  EXPECT_EQ(bytes_of(folder / "a.mp4"), bytes_of(folder / "b.mp4"));
}

TEST(VideoJoin, EncodesSoundThatMp4CannotHoldFromItsMomentOn) {
  const TemporaryFolder folder;
  const SoundTrack sound{put_sounding_video(folder), 1.0, 2.5};
  ASSERT_EQ(sound_codec(sound.video), "pcm_s16le");
  join_videos(put_segments(folder, {8, 7}), kRate, sound, folder / "joined.mp4");
  EXPECT_EQ(sound_codec(folder / "joined.mp4"), "aac");
  EXPECT_EQ(frame_numbers(folder / "joined.mp4"), numbers_up_to(15));
  const Sound joined = read_sound(folder / "joined.mp4");
  EXPECT_EQ(joined.samples_per_second, 16000);
  EXPECT_NEAR(static_cast<double>(joined.samples.size()), 1.5 * 16000, 1);
  EXPECT_NEAR(delay_of(joined, rising_tone(4, 16000), 16000), 0, 1);
}

TEST(VideoJoin, CopiesSoundThatMp4CanHoldFromItsMomentOn) {
  const TemporaryFolder folder;
  const SoundTrack raw{put_sounding_video(folder), 0, 4};
  join_videos(put_segments(folder, {26}, {13, 2}), {13, 2}, raw, folder / "aac.mp4");
  const Sound whole = read_sound(folder / "aac.mp4");
  ASSERT_EQ(sound_codec(folder / "aac.mp4"), "aac");
  EXPECT_NEAR(delay_of(whole, rising_tone(4, 16000), 0), 0, 1);
  for (const double begin : {0.0, 1.0, 2.4321}) {
    const SoundTrack sound{folder / "aac.mp4", begin, begin + 1.5};
    join_videos(put_segments(folder, {8, 7}), kRate, sound, folder / "joined.mp4");
    EXPECT_EQ(frame_numbers(folder / "joined.mp4"), numbers_up_to(15));
    const Sound joined = read_sound(folder / "joined.mp4");
    // Whole packets of 1024 samples.
    EXPECT_NEAR(static_cast<double>(joined.samples.size()), 1.5 * 16000, 1024);
    const int first = static_cast<int>(std::lround(begin * 16000));
    EXPECT_NEAR(delay_of(joined, rising_tone(4, 16000), first), 0, 16) << begin;
    // Copied, it is the same sound, and not the same encoded again.
    double difference = 0;
    const int delay = delay_of(joined, whole, first);
    for (int i = 3000; i < 15000; ++i) {
      difference = std::max<double>(
          difference, std::abs(joined.samples.at(static_cast<std::size_t>(i)) -
                               whole.samples.at(static_cast<std::size_t>(first + i - delay))));
    }
    EXPECT_LT(difference, 1e-4) << begin;
  }
}

TEST(VideoJoin, StartsAtTimeZeroInMatroska) {
  const TemporaryFolder folder;
  VideoWriter writer(folder / "segment.mkv", 64, 48,
                     {.rate = kRate, .coding = VideoCoding::kFfv1_16});
  for (int i = 0; i < 15; ++i) {
    writer.write(Photograph{Image<std::uint16_t>(64, 48)});
  }
  writer.finish();
  const std::vector<std::filesystem::path> segments = {folder / "segment.mkv"};
  // Encoded, and copied with a packet from before its start.
  join_videos(segments, kRate, {put_sounding_video(folder), 0, 1.5}, folder / "encoded.mkv");
  join_videos(segments, kRate, {folder / "encoded.mkv", 0.5, 1.5}, folder / "copied.mkv");
  for (const char* name : {"encoded.mkv", "copied.mkv"}) {
    const LibavInput input = open_media_file(folder / name);
    EXPECT_EQ(find_video_stream(*input)->start_time, 0) << name;
    EXPECT_EQ(sound_codec(folder / name), "aac");
  }
}

/// As recordings of television have it.
TEST(VideoJoin, FollowsSoundThatChangesBetweenStereoAndMono) {
  const TemporaryFolder folder;
  const auto segments = put_segments(folder, {15});
  for (const std::vector<int>& channels : {std::vector{2, 1}, {1, 2}, {2, 1, 2}}) {
    const int parts = static_cast<int>(channels.size());
    put_changing_sound(folder / "changing.mkv", channels);
    EXPECT_EQ(join_videos(segments, kRate, {folder / "changing.mkv", 0, 0.48 * parts},
                          folder / "joined.mp4"),
              "");
    EXPECT_EQ(sound_codec(folder / "joined.mp4"), "aac");
    const Sound joined = read_sound(folder / "joined.mp4");
    EXPECT_NEAR(static_cast<double>(joined.samples.size()), 0.48 * parts * 48000, 1500);
    // The tone is as loud in all parts.
    for (int part = 0; part < parts; ++part) {
      double sum = 0;
      for (int i = 0; i < 4800; ++i) {
        const auto at = static_cast<std::size_t>(23040 * part + 8000 + i);
        sum += joined.samples.at(at) * joined.samples.at(at);
      }
      EXPECT_NEAR(std::sqrt(sum / 4800), 0.5 / std::numbers::sqrt2, 0.12) << part;
    }
  }
}

TEST(VideoJoin, LeavesOutSoundThatCannotBeDecodedAndSaysWhy) {
  const TemporaryFolder folder;
  const auto segments = put_segments(folder, {8, 7});
  put_changing_sound(folder / "a.mkv", {2}, true);
  EXPECT_THAT(join_videos(segments, kRate, {folder / "a.mkv", 0, 0.4}, folder / "joined.mp4"),
              AllOf(HasSubstr("a.mkv"), HasSubstr("sound")));
  EXPECT_EQ(sound_codec(folder / "joined.mp4"), "");
  EXPECT_EQ(frame_numbers(folder / "joined.mp4"), numbers_up_to(15));
}

TEST(VideoJoin, TakesWhatSoundThereIs) {
  const TemporaryFolder folder;
  const auto segments = put_segments(folder, {15});
  join_videos(segments, kRate, {put_sounding_video(folder, 1.75), 1.0, 2.5}, folder / "short.mp4");
  EXPECT_NEAR(static_cast<double>(read_sound(folder / "short.mp4").samples.size()), 0.75 * 16000,
              1);
  EXPECT_EQ(VideoReader(folder / "short.mp4").frame_count(), 15);

  join_videos(segments, kRate, {put_sounding_video(folder, 0.5), 1.0, 2.5}, folder / "past.mp4");
  EXPECT_EQ(sound_codec(folder / "past.mp4"), "");
  join_videos(segments, kRate, {folder / "silent.mp4", 0, 1.5}, folder / "none.mp4");
  EXPECT_EQ(sound_codec(folder / "none.mp4"), "");
  EXPECT_EQ(bytes_of(folder / "none.mp4"), bytes_of(folder / "past.mp4"));
}

TEST(VideoJoin, RefusesWhatIsMissingDamagedOrDoesNotFit) {
  const TemporaryFolder folder;
  auto segments = put_segments(folder, {3, 4});
  const auto error_with = [&](const std::filesystem::path& segment, const SoundTrack& sound = {}) {
    const std::vector<std::filesystem::path> all = {segments[0], segments[1], segment};
    return error_of([&] { join_videos(all, kRate, sound, folder / "joined.mp4"); });
  };
  EXPECT_THAT(error_with(folder / "none.mp4"), AllOf(HasSubstr("none.mp4"), HasSubstr("no such")));
  put_numbered_video(folder / "wide.mp4", 2, kRate, 96, 48);
  EXPECT_THAT(error_with(folder / "wide.mp4"), AllOf(HasSubstr("wide.mp4"), HasSubstr("96x48")));
  put_numbered_video(folder / "fast.mp4", 2, {15, 1});
  EXPECT_THAT(error_with(folder / "fast.mp4"), HasSubstr("fast.mp4"));
  remux_video(segments[0], folder / "slow.mp4", "mp4", {7, 1});
  EXPECT_THAT(error_with(folder / "slow.mp4"),
              AllOf(HasSubstr("slow.mp4"), HasSubstr("has another frame rate, expected 10/1")));
  remux_video(segments[0], folder / "gap.mp4", "mp4", kRate, {},
              [](int frame) { return frame < 2 ? frame : frame + 1; });
  EXPECT_THAT(error_with(folder / "gap.mp4"), AllOf(HasSubstr("gap.mp4"), HasSubstr("frame 2")));
  auto bytes = bytes_of(segments[0]);
  bytes.resize(bytes.size() - 10);
  put_bytes(folder / "cut.mp4", bytes);
  EXPECT_THAT(error_with(folder / "cut.mp4"), AllOf(HasSubstr("cut.mp4"), HasSubstr("truncated")));
  EXPECT_THAT(error_with(segments[0], {folder / "none.mkv", 0, 1}), HasSubstr("none.mkv"));
  EXPECT_NE(error_of([&] { join_videos({}, kRate, {}, folder / "joined.mp4"); }), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "joined.mp4"));
}

}  // namespace vantage::video_join_test
