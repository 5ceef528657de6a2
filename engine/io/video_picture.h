#pragma once

#include <memory>
#include <string>

#include "engine/image/photograph.h"
#include "engine/io/frame_to_photograph.h"
#include "engine/io/libav.h"
#include "engine/object_pool.h"

namespace vantage {

/// Converters for pictures of one video: as many as are converted at a time.
using PictureConverters = ObjectPool<FrameToPhotograph>;

/// A frame of a video as its decoder has left it: luma and chroma, mostly. It shares the decoder's
/// memory and may outlive the reader that it came from.
class VideoPicture {
 public:
  /// Holds nothing.
  VideoPicture() = default;
  /// Refers to the pixels of `frame`. `name` is for messages: "a.mp4: frame 12".
  VideoPicture(const AVFrame& frame, std::shared_ptr<PictureConverters> converters,
               std::string name);

  [[nodiscard]] bool is_empty() const { return frame_ == nullptr; }
  /// Another reference to the same pixels.
  [[nodiscard]] VideoPicture share() const;

  /// Makes a photograph of it, whose memory is reused, and lets go of the decoder's. Thread rule:
  /// concurrently for different pictures. Throws Error, with the name, when its pixel format cannot
  /// be converted.
  void convert(Photograph& photograph);

 private:
  LibavFrame frame_;
  std::shared_ptr<PictureConverters> converters_;
  std::string name_;
};

}  // namespace vantage
