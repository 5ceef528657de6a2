// Luma and chroma of frames, against libswscale.

#include "engine/io/video/frame_to_photograph.h"

#include "engine/image/stereo_packing.h"
#include "engine/io/video/chroma_upsampler.h"
#include "engine/io/video/libav_scaler.h"
#include "tests/engine/engine_test.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace vantage::frame_to_photograph_test {

/// Noise with many samples of the least and the largest value.
LibavFrame noisy_frame(int width, int height, AVPixelFormat format) {
  std::mt19937 random(static_cast<unsigned>(width + height));
  LibavFrame frame = make_picture(width, height, format);
  for (int plane = 0; plane < 3; ++plane) {
    const int shift = plane == 0 ? 0 : describe_pixel_format(format).log2_chroma_h;
    const int rows = AV_CEIL_RSHIFT(height, shift);
    for (int i = 0; i < frame->linesize[plane] * rows; ++i) {
      const auto kind = random() % 4;
      frame->data[plane][i] = static_cast<std::uint8_t>(kind == 0 ? 0 : kind == 1 ? 255 : random());
    }
  }
  return frame;
}

TEST(ChromaUpsampler, IsLibswscaleToTheBit) {
  for (const auto& [width, height] : std::initializer_list<std::array<int, 2>>{
           {14, 14}, {16, 14}, {14, 18}, {36, 16}, {130, 52}, {646, 22}}) {
    SCOPED_TRACE(testing::Message() << width << "x" << height);
    const LibavFrame frame = noisy_frame(width, height, AV_PIX_FMT_YUV420P);
    ASSERT_TRUE(ChromaUpsampler::serves(*frame));
    const LibavFrame expected = make_picture(width, height, AV_PIX_FMT_YUV444P16);
    const LibavScaler scaler =
        make_scaler({.width = width,
                     .height = height,
                     .source_format = frame->format,
                     .target_format = expected->format,
                     .source_full_range = false,
                     .target_full_range = false,
                     .source_chroma =
                         chroma_position(AVCHROMA_LOC_LEFT, describe_pixel_format(frame->format))});
    sws_scale(scaler.get(), frame->data, frame->linesize, 0, height, expected->data,
              expected->linesize);
    ChromaUpsampler upsampler;
    upsampler.begin(*frame);
    for (int y = 0; y < height; ++y) {
      const kernels::LumaChromaRow row = upsampler.next_row();
      ASSERT_EQ(row.width, width);
      const std::uint16_t* const planes[] = {row.luma, row.chroma_blue, row.chroma_red};
      for (int plane = 0; plane < 3; ++plane) {
        const auto* const expected_row = reinterpret_cast<const std::uint16_t*>(
            expected->data[plane] + std::ptrdiff_t{y} * expected->linesize[plane]);
        for (int x = 0; x < width; ++x) {
          ASSERT_EQ(planes[plane][x], expected_row[x]) << plane << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(ChromaUpsampler, ServesNoOtherChroma) {
  for (const int location : {AVCHROMA_LOC_CENTER, AVCHROMA_LOC_TOPLEFT}) {
    const LibavFrame frame = make_picture(14, 14, AV_PIX_FMT_YUV420P);
    frame->chroma_location = static_cast<AVChromaLocation>(location);
    EXPECT_FALSE(ChromaUpsampler::serves(*frame));
  }
  EXPECT_FALSE(ChromaUpsampler::serves(*make_picture(15, 14, AV_PIX_FMT_YUV420P)));
  EXPECT_FALSE(ChromaUpsampler::serves(*make_picture(14, 15, AV_PIX_FMT_YUV420P)));
  EXPECT_FALSE(ChromaUpsampler::serves(*make_picture(12, 14, AV_PIX_FMT_YUV420P)));
  EXPECT_FALSE(ChromaUpsampler::serves(*make_picture(14, 14, AV_PIX_FMT_YUV422P)));
}

TEST(FrameToPhotograph, HalvesAreTheColumnsOfTheWhole) {
  FrameToPhotograph converter;
  // The last two are libswscale's.
  for (const auto& [width, format] :
       std::initializer_list<std::pair<int, AVPixelFormat>>{{14, AV_PIX_FMT_YUV420P},
                                                            {140, AV_PIX_FMT_YUV420P},
                                                            {26, AV_PIX_FMT_YUV444P},
                                                            {26, AV_PIX_FMT_YUV420P10}}) {
    const LibavFrame frame = noisy_frame(width, 14, format);
    Photograph whole;
    Photograph left;
    Photograph right;
    converter.convert(*frame, whole);
    ASSERT_TRUE(converter.convert_halves(*frame, {&left, &right}));
    Photograph only_right;
    ASSERT_TRUE(converter.convert_halves(*frame, {nullptr, &only_right}));
    EXPECT_TRUE(same(right, only_right));
    Photograph expected_left;
    Photograph expected_right;
    unpack_stereo(whole, {}, expected_left, expected_right);
    EXPECT_TRUE(same(left, expected_left));
    EXPECT_TRUE(same(right, expected_right));
  }
  const LibavFrame odd = noisy_frame(9, 6, AV_PIX_FMT_YUV420P);
  Photograph half;
  EXPECT_FALSE(converter.convert_halves(*odd, {&half, &half}));
}

}  // namespace vantage::frame_to_photograph_test
