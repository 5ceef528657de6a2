#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "engine/image/orientation.h"
#include "engine/image/photograph.h"
#include "engine/io/video/frame_to_photograph.h"
#include "engine/io/video/libav.h"
#include "engine/object_pool.h"

namespace vantage {

/// Converters for pictures of one video: one per concurrent conversion.
using PictureConverters = ObjectPool<FrameToPhotograph>;

/// How the frames of one video become photographs.
struct PictureHandling {
  std::string lossy_codec = {};  ///< as LossyCoding has it; empty: lossless
  Orientation turn = Orientation::kAsStored;
  /// Interlaced frames: colours of each field by itself, for fields that are different pictures.
  bool takes_fields_apart = false;
  enum class Deinterlacing { kNone, kFlaggedFrames, kAllFrames };
  Deinterlacing deinterlacing = Deinterlacing::kNone;
};

/// A decoded frame of a video, usually luma and chroma. It shares the decoder's memory and may
/// outlive its reader.
class VideoPicture {
 public:
  /// Holds nothing.
  VideoPicture() = default;
  /// Refers to the pixels of `frame`. `name` is for messages: "a.mp4: frame 12".
  VideoPicture(const AVFrame& frame, std::shared_ptr<PictureConverters> converters,
               std::string name, PictureHandling handling = {});

  [[nodiscard]] bool is_empty() const { return frame_ == nullptr; }
  /// Another reference to the same pixels.
  [[nodiscard]] VideoPicture share() const;
  /// The pictures before and after it, which deinterlacing looks at; empty where there is none.
  void set_neighbours(const VideoPicture& before, const VideoPicture& after);
  /// Memory of its pixels.
  [[nodiscard]] std::size_t bytes() const;

  /// Converts it to a photograph, whose memory is reused, deinterlaced and turned as its video is
  /// handled, and releases the decoder's memory. Where it can, it makes `halves` instead, and
  /// returns true; with none, never. Thread rule: concurrently for different pictures. Throws
  /// Error, with the name, when its pixel format cannot be converted.
  bool convert(Photograph& photograph, const PictureHalves& halves = {});

 private:
  LibavFrame frame_;
  std::shared_ptr<PictureConverters> converters_;
  std::string name_;
  PictureHandling handling_;
  LibavFrame before_;
  LibavFrame after_;
};

}  // namespace vantage
