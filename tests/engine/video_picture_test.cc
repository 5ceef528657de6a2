// Pictures of videos, of which threads make photographs concurrently.

#include "engine/io/video/video_picture.h"

#include "engine/io/images/photograph_io.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav_scaler.h"
#include "engine/io/video/video_io.h"
#include "engine/sequence/sequence_runner.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixfmt.h>
}

namespace vantage::video_picture_test {

namespace fs = std::filesystem;

constexpr FrameRate kRate{10, 1};
constexpr int kFrames = 24;
constexpr int kGroup = 7;

TEST(VideoPicture, ThreadsMakeTheSamePhotographsInAnyOrder) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", kFrames, kRate, 638, 478);  // long enough to overlap
  std::vector<FetchedFrame> frames(kFrames);
  {
    const auto source = open_frame_source(folder / "a.mp4");
    for (FetchedFrame& frame : frames) {
      ASSERT_TRUE(source->fetch(frame));
      ASSERT_FALSE(frame.picture.is_empty());
    }
  }  // pictures outlive their source
  std::vector<int> order(kFrames);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::atomic<std::size_t> next{0};
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < order.size(); i = next++) {
      frames[static_cast<std::size_t>(order[i])].decode();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back(take_turns);
    }
  }
  VideoReader reader(folder / "a.mp4");
  Photograph expected;
  for (int i = 0; i < kFrames; ++i) {
    const FetchedFrame& frame = frames[static_cast<std::size_t>(i)];
    ASSERT_TRUE(reader.read(expected));
    EXPECT_TRUE(same(frame.photograph, expected)) << i;
    EXPECT_EQ(number_of_frame(frame.photograph), i);
    EXPECT_TRUE(frame.picture.is_empty()) << "the decoder's memory is still held";
  }
}

TEST(VideoPicture, WhatCannotBeConvertedIsOneBadFrame) {
  const auto converters = std::make_shared<PictureConverters>();
  const LibavFrame frame = make_picture(4, 2, AV_PIX_FMT_YUV420P);
  for (int plane = 0; plane < 3; ++plane) {
    std::fill_n(frame->data[plane], frame->linesize[plane] * (plane == 0 ? 2 : 1),
                std::uint8_t{128});
  }
  frame->colorspace = AVCOL_SPC_YCGCO;
  Photograph photograph;
  VideoPicture strange(*frame, converters, "film.mp4: frame 7");
  EXPECT_EQ(error_of([&] { strange.convert(photograph); }),
            "film.mp4: frame 7: its colour matrix 8 is not supported");
  frame->colorspace = AVCOL_SPC_BT709;
  VideoPicture(*frame, converters, "film.mp4: frame 8").convert(photograph);
  EXPECT_EQ(std::get<Image<std::uint8_t>>(photograph.pixels).at(3, 1, 2), 130);  // (128 − 16)/219
}

TEST(VideoPicture, ReferencesToOnePictureAreConvertedApart) {
  const LibavFrame frame = make_picture(3, 1, AV_PIX_FMT_GRAY8);
  std::fill_n(frame->data[0], 3, std::uint8_t{77});
  VideoPicture first(*frame, std::make_shared<PictureConverters>(), "a");
  VideoPicture second = first.share();
  for (VideoPicture* picture : {&first, &second}) {
    Photograph photograph;
    picture->convert(photograph);
    EXPECT_EQ(std::get<Image<std::uint8_t>>(photograph.pixels).at(2, 0), 77);
  }
  EXPECT_TRUE(VideoPicture().share().is_empty());
}

/// A run over a packed video; what it says of frames, and its files.
struct Outcome {
  std::map<int, std::string> skipped;
  std::map<std::string, std::vector<std::uint8_t>> files;
};

Outcome run_over(const fs::path& video, const fs::path& folder, int threads, int in_flight) {
  SequenceOptions options;
  options.match.disparities = {0, 7};
  options.save = {SequenceOutput::kDisparity, SequenceOutput::kStereo};
  PairSourceOptions input;
  input.stereo = video.string();
  input.packing = StereoPacking{};
  const auto pairs = open_pair_source(input);
  Execution execution({.threads = threads});
  const SequenceLayout layout(folder, options);
  RunIdentity identity;
  identity.frame_count = kFrames;
  RunJournal journal(layout.journal_folder(), identity, JournalOpening::kNew, "all");
  const SequenceRun run{.pairs = *pairs,
                        .selection = {.frame_count = kFrames,
                                      .chunk_frames = options.chunk_frames,
                                      .frames = std::nullopt,
                                      .shard = std::nullopt},
                        .frame_size = ImageExtent{32, 48},
                        .in_flight = in_flight,
                        .keep_going = true,
                        .on_progress = {}};
  Outcome outcome;
  for (const FrameRemark& skipped :
       SequenceRunner(options, execution).run(run, layout, journal).skipped) {
    outcome.skipped[skipped.frame] = skipped.text;
  }
  for (const char* kind : {"disparity", "stereo"}) {
    for (const auto& entry : fs::directory_iterator(folder / kind)) {
      outcome.files[kind + ("/" + entry.path().filename().string())] = bytes_of(entry.path());
    }
  }
  return outcome;
}

TEST(VideoPicture, RunsOverDamagedVideosAreTheSameHoweverManyWork) {
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  const auto packets = video_packets(folder / "a.mp4");
  auto bytes = bytes_of(folder / "a.mp4");
  std::fill_n(bytes.begin() + packets[kGroup + 2].offset, 4, std::uint8_t{0xFF});
  put_bytes(folder / "a.mp4", bytes);
  std::optional<Outcome> expected;
  for (const auto& [threads, in_flight] : {std::pair{1, 1}, {1, 4}, {2, 2}, {2, 6}, {4, 9}}) {
    SCOPED_TRACE(testing::Message() << threads << " threads, " << in_flight << " in flight");
    const fs::path out = folder / (std::to_string(threads) + "-" + std::to_string(in_flight));
    const Outcome outcome = run_over(folder / "a.mp4", out, threads, in_flight);
    if (!expected) {
      expected = outcome;
      ASSERT_FALSE(outcome.skipped.empty());
      EXPECT_GE(outcome.skipped.begin()->first, kGroup);
      EXPECT_EQ(outcome.skipped.rbegin()->first, 2 * kGroup - 1);
      EXPECT_EQ(outcome.files.size(), 2 * (kFrames - outcome.skipped.size()));
      for (int frame = 0; frame < kFrames; ++frame) {
        if (!outcome.skipped.contains(frame)) {
          const std::string number = std::to_string(frame);
          const fs::path file =
              out / "stereo" / (std::string(6 - number.size(), '0') + number + ".png");
          EXPECT_EQ(number_of_frame(read_photograph(file.string())), frame);
        }
      }
    }
    EXPECT_EQ(outcome.skipped, expected->skipped);
    EXPECT_EQ(outcome.files, expected->files);
  }
}

}  // namespace vantage::video_picture_test
