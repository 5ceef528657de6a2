#include "engine/io/video/video_picture.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/image/white_level.h"
#include "engine/io/video/frame_quantisation.h"

extern "C" {
#include <libavutil/frame.h>
}

namespace vantage {

VideoPicture::VideoPicture(const AVFrame& frame, std::shared_ptr<PictureConverters> converters,
                           std::string name, std::string lossy_codec)
    : frame_(av_frame_clone(&frame)),
      converters_(std::move(converters)),
      name_(std::move(name)),
      lossy_codec_(std::move(lossy_codec)) {
  if (frame_ == nullptr) {
    throw std::bad_alloc();
  }
}

VideoPicture VideoPicture::share() const {
  return is_empty() ? VideoPicture() : VideoPicture(*frame_, converters_, name_, lossy_codec_);
}

std::size_t VideoPicture::bytes() const {
  std::size_t bytes = 0;
  for (int plane = 0; !is_empty() && plane < AV_NUM_DATA_POINTERS; ++plane) {
    bytes += frame_->buf[plane] == nullptr ? 0 : frame_->buf[plane]->size;
  }
  return bytes;
}

void VideoPicture::convert(Photograph& photograph) {
  const LibavFrame frame = std::move(frame_);
  const auto converter = converters_->borrow();
  photograph.origin = {};
  if (!lossy_codec_.empty()) {
    photograph.origin.coding = coding_of_frame(*frame, lossy_codec_);
  }
  try {
    converter->convert(*frame, photograph);
    // Formats say how many bits they have.
    photograph.origin.white_level = WhiteLevel::kOfTypes[photograph.pixels.index()];
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name_, error.what()));
  }
}

}  // namespace vantage
