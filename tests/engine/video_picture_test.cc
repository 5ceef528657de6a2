// Pictures of videos, of which threads make photographs concurrently.

#include "engine/io/video/video_picture.h"

#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav_scaler.h"
#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixfmt.h>
}

namespace vantage::video_picture_test {

constexpr FrameRate kRate{10, 1};
constexpr int kFrames = 24;

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

}  // namespace vantage::video_picture_test
