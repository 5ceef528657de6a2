// Video files that end too early.

#include "engine/io/video/video_io.h"
#include "engine/io/video/video_structure.h"
#include "engine/io/video/writing/video_join.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

namespace vantage::truncated_video_test {

constexpr FrameRate kRate{10, 1};

std::vector<std::uint8_t> first_bytes(const std::vector<std::uint8_t>& bytes, std::int64_t count) {
  return {bytes.begin(), bytes.begin() + count};
}

/// Reads `path`, of whose frames the first `frames` are there.
void expect_frames_before_the_cut(const std::filesystem::path& path, int frames) {
  SCOPED_TRACE(testing::Message() << "of " << std::filesystem::file_size(path) << " bytes");
  VideoReader reader(path);
  Photograph frame;
  for (int i = 0; i < frames; ++i) {
    ASSERT_TRUE(reader.read(frame)) << i;
    EXPECT_EQ(number_of_frame(frame), i);
  }
  EXPECT_GT(reader.frame_count(), frames);
  EXPECT_THAT(error_of([&] { reader.read(frame); }),
              AllOf(HasSubstr(path.filename().string() + ": frame " + std::to_string(frames) + " "),
                    HasSubstr("the file")));
  EXPECT_FALSE(reader.read(frame)) << "a video ends with its damage";
}

/// Cuts the video before, just behind the beginning of, and in the middle of each of its packets.
void cut_everywhere(const std::filesystem::path& path, const std::filesystem::path& cut) {
  const std::vector<VideoPacket> packets = video_packets(path);
  const auto whole = bytes_of(path);
  for (std::size_t i = 1; i < packets.size(); ++i) {
    int first_lost = packets[i].frame;
    for (std::size_t k = i; k < packets.size(); ++k) {
      first_lost = std::min(first_lost, packets[k].frame);
    }
    const std::int64_t begin = packets[i].offset;
    const std::int64_t middle =
        i + 1 < packets.size() ? (begin + packets[i + 1].offset) / 2 : begin;
    for (const std::int64_t size : {begin, begin + 5, middle}) {
      put_bytes(cut, first_bytes(whole, size));
      expect_frames_before_the_cut(cut, first_lost);
      if (testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

TEST(TruncatedVideo, TheFramesBeforeTheCutAreThere) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 14, kRate);
  put_open_groups_video(folder / "groups.mp4", 14, kRate);
  for (const char* video : {"a.mp4", "groups.mp4"}) {
    remux_video(folder / video, folder / "whole.mkv", "matroska", kRate);
    cut_everywhere(folder / "whole.mkv", folder / "cut.mkv");
  }
  cut_everywhere(folder / "a.mp4", folder / "cut.mp4");  // its index comes first
}

TEST(TruncatedVideo, OfRawVideoToo) {
  const TemporaryFolder folder;
  constexpr int kWidth = 8;
  constexpr int kHeight = 6;
  RawVideo video{"mono", 8, true, kWidth, kHeight, {}};
  for (int i = 0; i < 5; ++i) {
    video.frames.push_back({std::vector<int>(kWidth * kHeight, 20 + 9 * i)});
  }
  put_raw_video(folder / "whole.y4m", video);
  EXPECT_EQ(VideoReader(folder / "whole.y4m").frame_count(), 5);
  const auto whole = bytes_of(folder / "whole.y4m");
  constexpr std::int64_t kFrameBytes = 6 + kWidth * kHeight;
  const std::int64_t header = static_cast<std::int64_t>(whole.size()) - 5 * kFrameBytes;
  for (int frames = 1; frames < 5; ++frames) {
    const std::int64_t end = header + frames * kFrameBytes;
    for (const std::int64_t more : {std::int64_t{1}, std::int64_t{6}, kFrameBytes - 1}) {
      put_bytes(folder / "cut.y4m", first_bytes(whole, end + more));
      expect_frames_before_the_cut(folder / "cut.y4m", frames);
    }
    // Nothing tells that there were more.
    put_bytes(folder / "cut.y4m", first_bytes(whole, end));
    EXPECT_EQ(frame_numbers(folder / "cut.y4m").size(), static_cast<std::size_t>(frames));
  }
}

/// What lies behind the frames is no loss.
TEST(TruncatedVideo, AllFramesAreThereWhereOnlyWhatFollowsThemIsCutOff) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 12, kRate);
  remux_video(folder / "a.mp4", folder / "b.mkv", "matroska", kRate);
  const auto whole = bytes_of(folder / "b.mkv");
  EXPECT_EQ(find_video_extent(folder / "b.mkv"), VideoExtent::kWhole);
  put_bytes(folder / "b.mkv", first_bytes(whole, static_cast<std::int64_t>(whole.size()) - 1));
  EXPECT_EQ(find_video_extent(folder / "b.mkv"), VideoExtent::kWhole);
  EXPECT_EQ(VideoReader(folder / "b.mkv").frame_count(), 12);
  EXPECT_EQ(frame_numbers(folder / "b.mkv").size(), 12U);
  put_bytes(folder / "b.mkv", first_bytes(whole, static_cast<std::int64_t>(whole.size()) / 2));
  EXPECT_EQ(find_video_extent(folder / "b.mkv"), VideoExtent::kCutOff);
  EXPECT_THAT(error_of([&] { check_video_is_whole(folder / "b.mkv"); }), HasSubstr("truncated"));
}

TEST(TruncatedVideo, AviTellsByItsChunks) {
  const TemporaryFolder folder;
  const std::string header = std::string("LIST") + '\x05' + std::string(3, '\0') + "hdrl..";
  const std::string frames = std::string("LIST") + '\x0A' + std::string(3, '\0') + "movi......";
  const std::string index = std::string("idx1") + '\x04' + std::string(3, '\0') + "....";
  const std::string contents = "AVI " + header + frames + index;
  const std::string whole =
      std::string("RIFF") + static_cast<char>(contents.size()) + std::string(3, '\0') + contents;
  for (std::size_t size = 12; size <= whole.size(); ++size) {
    put_text(folder / "a.avi", whole.substr(0, size));
    EXPECT_EQ(find_video_extent(folder / "a.avi"),
              size + index.size() < whole.size() ? VideoExtent::kCutOff : VideoExtent::kWhole)
        << size;
  }
}

/// Their frames that are missing would be shown before the last ones, or the last packet is cut.
TEST(TruncatedVideo, TransportStreamsTellByPacketsAndByFramesThatWereToCome) {
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", 24, kRate, 8);
  remux_video(folder / "a.mp4", folder / "whole.ts", "mpegts", kRate);
  EXPECT_EQ(frame_numbers(folder / "whole.ts").size(), 24U);
  const auto whole = bytes_of(folder / "whole.ts");
  ASSERT_EQ(whole.size() % 188, 0U);
  int errors = 0;
  int cuts = 0;
  const auto packets = video_packets(folder / "whole.ts");
  for (std::size_t i = packets.size() / 2; i < packets.size() / 2 + 4; ++i, ++cuts) {
    // Behind the packets of a frame, where no packet tells.
    put_bytes(folder / "cut.ts", first_bytes(whole, packets[i].offset));
    int last_in_order = -1;
    std::vector<int> there;
    for (std::size_t k = 0; k < i; ++k) {
      there.push_back(packets[k].frame);
    }
    std::sort(there.begin(), there.end());
    while (last_in_order + 1 < static_cast<int>(there.size()) &&
           there[static_cast<std::size_t>(last_in_order + 1)] == last_in_order + 1) {
      ++last_in_order;
    }
    const bool lacks_some = last_in_order + 1 < static_cast<int>(there.size());
    const std::string problem = error_of([&] {
      VideoReader reader(folder / "cut.ts");
      for (int frame = 0; frame < reader.frame_count() && reader.skip(); ++frame) {
      }
    });
    errors += lacks_some ? 1 : 0;
    EXPECT_EQ(!problem.empty(), lacks_some) << i << " " << problem;
    // In the middle of a packet.
    put_bytes(folder / "cut.ts", first_bytes(whole, packets[i].offset + 90));
    EXPECT_EQ(find_video_extent(folder / "cut.ts"), VideoExtent::kCutOff);
    EXPECT_THAT(error_of([&] { frame_numbers(folder / "cut.ts"); }), HasSubstr("cut off"));
  }
  EXPECT_GT(errors, 0);
  // A recording that begins anywhere.
  put_bytes(folder / "middle.ts", {whole.begin() + 100, whole.end()});
  EXPECT_EQ(find_video_extent(folder / "middle.ts"), VideoExtent::kWhole);
}

/// Wherever the file ends: frames follow each other, or an error names the one that is missing.
/// Lost are those that others were decoded before, and what is torn.
TEST(TruncatedVideo, TransportStreamsHaveNoGaps) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 20, kRate);
  remux_video(folder / "a.mp4", folder / "whole.ts", "mpegts", kRate);
  const auto whole = bytes_of(folder / "whole.ts");
  int errors = 0;
  for (std::size_t packets = 30; packets < whole.size() / 188; packets += 5) {
    const bool is_torn = packets % 2 == 0;
    const std::size_t size = 188 * packets + (is_torn ? 100 : 0);
    put_bytes(folder / "cut.ts", first_bytes(whole, static_cast<std::int64_t>(size)));
    VideoReader reader(folder / "cut.ts");
    Photograph frame;
    int count = 0;
    const std::string error = error_of([&] {
      for (; reader.read(frame); ++count) {
        EXPECT_EQ(number_of_frame(frame), count) << size;
      }
    });
    EXPECT_LT(count, 20) << size;
    EXPECT_TRUE(!is_torn || !error.empty()) << size;
    if (!error.empty()) {
      EXPECT_THAT(error, HasSubstr("cut.ts: frame " + std::to_string(count) + " ")) << size;
      ++errors;
    }
  }
  EXPECT_GT(errors, 2);
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>(value >> shift & 255));
  }
  return bytes;
}

std::string box(const std::string& type, const std::string& contents) {
  return big_endian(static_cast<std::uint32_t>(contents.size() + 8)) + type + contents;
}

TEST(VideoTables, MustNotPromiseMoreSamplesThanTheFileCanHold) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& table) {
    put_text(folder / "a.mp4",
             box("ftyp", "isom....") +
                 box("moov", box("trak", box("mdia", box("minf", box("stbl", table))))));
    return error_of([&] { check_video_tables(folder / "a.mp4"); });
  };
  const auto sizes = [](std::uint32_t bytes, std::uint32_t samples) {
    return box("stsz", std::string(4, '\0') + big_endian(bytes) + big_endian(samples));
  };
  EXPECT_EQ(problem(sizes(4, 100)), "");
  EXPECT_EQ(problem(sizes(0, 50'000'000)), "");  // with a table, whose length readers look at
  EXPECT_THAT(problem(sizes(1, 50'000'000)),
              AllOf(HasSubstr("a.mp4"), HasSubstr("cannot hold the 50000000 samples")));
  put_text(folder / "b.mp4",
           box("ftyp", "isom....") +
               box("moof", box("traf", box("trun", big_endian(1) + big_endian(50'000'000)))));
  EXPECT_THAT(error_of([&] { VideoReader(folder / "b.mp4"); }), HasSubstr("cannot hold"));
  // Boxes within boxes to any depth are no matter of ours.
  std::string nested;
  for (int i = 0; i < 2000; ++i) {
    nested = box("moov", nested);
  }
  put_text(folder / "c.mp4", nested);
  EXPECT_EQ(error_of([&] { check_video_tables(folder / "c.mp4"); }), "");
}

/// So that the frames before the cut can be joined with it, wherever the cut is.
TEST(TruncatedVideo, ItsSoundEndsAtTheCut) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 20, kRate);
  Sound sound{8000, std::vector<float>(16000)};
  for (std::size_t i = 0; i < sound.samples.size(); ++i) {
    sound.samples[i] = static_cast<float>(i % 40) / 80;
  }
  // Packets that are encoded again, and packets that are copied.
  remux_video(folder / "a.mp4", folder / "encoded.mkv", "matroska", kRate, sound);
  const std::vector<std::filesystem::path> segments = {folder / "a.mp4"};
  join_videos(segments, kRate, {folder / "encoded.mkv", 0, 2}, folder / "copied.mp4");
  for (const char* video : {"encoded.mkv", "copied.mp4"}) {
    const auto whole = bytes_of(folder / video);
    const auto size = static_cast<std::int64_t>(whole.size());
    for (std::int64_t bytes = size * 3 / 4; bytes < size * 3 / 4 + 300; bytes += 23) {
      put_bytes(folder / "cut", first_bytes(whole, bytes));
      ASSERT_EQ(find_video_extent(folder / "cut"), VideoExtent::kCutOff);
      ASSERT_EQ(error_of([&] {
                  join_videos(segments, kRate, {folder / "cut", 0, 2}, folder / "joined.mp4");
                }),
                "")
          << video << " " << bytes;
      const auto samples = read_sound(folder / "joined.mp4").samples.size();
      EXPECT_GT(samples, 4000U);
      EXPECT_LT(samples, 16000U);
    }
  }
}

TEST(TruncatedVideo, AnMp4WithoutIndexIsRefusedAndSaysWhy) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 12, kRate);
  put_open_groups_video(folder / "index-last.mp4", 12, kRate);
  for (const char* video : {"a.mp4", "index-last.mp4"}) {
    const auto whole = bytes_of(folder / video);
    const auto size = static_cast<std::int64_t>(whole.size());
    for (const std::int64_t bytes :
         {std::int64_t{50}, video == std::string("a.mp4") ? std::int64_t{200} : size - 1}) {
      put_bytes(folder / "b.mp4", first_bytes(whole, bytes));
      EXPECT_THAT(error_of([&] { VideoReader(folder / "b.mp4"); }),
                  AllOf(HasSubstr("b.mp4"), HasSubstr("index"), HasSubstr(std::to_string(bytes))));
    }
  }
}

}  // namespace vantage::truncated_video_test
