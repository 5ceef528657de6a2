#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/image/photograph.h"

namespace vantage {

/// The frames of one camera, one after the other. Thread rule: one thread at a time.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Reads the next frame into `frame`; false after the last one. Throws Error naming the frame
  /// when it is bad; the call after that goes on with the frame behind it where the source can
  /// (image files can, a video ends).
  virtual bool next(Photograph& frame) = 0;

  /// Frames there are in all, where that is known before reading them; an estimate for some videos.
  [[nodiscard]] virtual std::optional<int> frame_count() const = 0;

  /// Names frame `index`, counted from 0: the file, or "video.mp4 frame 12".
  [[nodiscard]] virtual std::string describe(int index) const = 0;

  /// Empty for image files.
  [[nodiscard]] virtual std::optional<double> frames_per_second() const = 0;
};

/// Opens what `spec` names; something that exists under that very name goes first:
/// - a folder: all image files in it, in natural order (frame2 before frame10), hidden ones left
///   out;
/// - a file: one image, or a video;
/// - a printf pattern with one %d or %0Nd in the file name ("left/%06d.png"): from the smallest
///   number present to the largest; a number missing between them is a bad frame;
/// - a glob pattern in the file name ("left/*.png", with * ? and [a-z]), in natural order.
///
/// Throws Error when nothing matches, a folder holds no image, or a video does not open;
/// UsageError for a malformed pattern.
std::unique_ptr<FrameSource> open_frame_source(const std::string& spec);

}  // namespace vantage
