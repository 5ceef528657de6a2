// Videos that come through a pipe.
#include "engine/io/video/streams/streamed_video.h"

#include <sys/stat.h>

#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

namespace vantage::streamed_video_test {

constexpr FrameRate kRate{25, 1};

/// Numbers of the frames of a stream; errors and remarks as they are.
std::vector<std::string> outcomes_of(const TemporaryFolder& folder,
                                     const std::vector<std::uint8_t>& bytes) {
  const std::filesystem::path pipe = folder / "pipe";
  EXPECT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::jthread sender([&] { put_bytes(pipe, bytes); });
  StreamedVideo video(std::make_unique<StreamInput>(pipe.string(), nullptr), std::nullopt, kRate);
  std::vector<std::string> outcomes;
  for (bool goes_on = true; goes_on;) {
    try {
      FetchedFrame frame;
      goes_on = video.fetch(frame);
      if (goes_on) {
        frame.decode();
        outcomes.insert(outcomes.end(), frame.remarks.begin(), frame.remarks.end());
        outcomes.push_back(std::to_string(number_of_frame(frame.photograph)));
      }
    } catch (const Error& error) {
      outcomes.emplace_back(error.what());
    }
  }
  std::filesystem::remove(pipe);
  return outcomes;
}

/// What follows damage is left out up to the next frame that can be decoded alone.
TEST(StreamedVideo, GoesOnBehindDamageAndCountsWhatItTook) {
  constexpr int kFrames = 15;
  constexpr int kGroup = 5;
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  remux_video(folder / "a.mp4", folder / "a.mkv", "matroska", kRate);
  const auto whole = bytes_of(folder / "a.mkv");
  std::vector<std::string> all;
  for (int frame = 0; frame < kFrames; ++frame) {
    all.push_back(std::to_string(frame));
  }
  EXPECT_EQ(outcomes_of(folder, whole), all);

  // The length of the part that the picture begins with, behind the header of a short block.
  constexpr std::ptrdiff_t kBlockHeader = 6;
  const std::vector<VideoPacket> packets = video_packets(folder / "a.mkv");
  const auto damaged = std::ranges::find_if(
      packets, [](const VideoPacket& packet) { return packet.frame == kGroup && packet.key; });
  ASSERT_NE(damaged, packets.end());
  auto bytes = whole;
  std::fill_n(bytes.begin() + damaged->offset + kBlockHeader, 4, std::uint8_t{0xFF});
  std::vector<std::string> outcomes = outcomes_of(folder, bytes);
  ASSERT_EQ(outcomes.size(), std::size_t{kFrames - kGroup + 2}) << testing::PrintToString(outcomes);
  EXPECT_THAT(outcomes[kGroup],
              AllOf(HasSubstr("pipe frame 5: is damaged"), HasSubstr("and what depends on it")));
  EXPECT_THAT(outcomes[kGroup + 1], HasSubstr("4 frames are missing before"));
  EXPECT_THAT(outcomes[kGroup + 1], HasSubstr("pipe frame 6"));
  outcomes.erase(outcomes.begin() + kGroup, outcomes.begin() + kGroup + 2);
  all.erase(all.begin() + kGroup, all.begin() + 2 * kGroup);
  EXPECT_EQ(outcomes, all);
}

}  // namespace vantage::streamed_video_test
