#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/frame_rate.h"
#include "engine/io/video_picture.h"

namespace vantage {

/// A frame on its way from a source: fetched in order by one thread, decoded by any.
struct FetchedFrame {
  std::filesystem::path file;  ///< the image file still to be read; empty: none
  VideoPicture picture;        ///< that the photograph is still to be made of; empty: none
  Photograph photograph;       ///< reused from frame to frame
  int frames_missing = 0;      ///< frames of a video that should lie between it and the one before
  /// What is odd about the frame though it can be used ("2 frames are missing before it").
  std::vector<std::string> remarks;

  /// Makes `photograph` of `file` or `picture`, if there is one. Thread rule: concurrently for
  /// different frames. Throws Error naming the file or frame.
  void decode();
};

/// The frames of one camera, one after the other. Thread rule: one thread at a time.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fetches the next frame; false after the last one, which in some videos comes a few frames
  /// before frame_count(). Throws Error naming the frame when it is bad; the call after that goes
  /// on with the frame behind it. Behind a bad frame of a video others are bad too, up to the
  /// next that can be decoded without it.
  virtual bool fetch(FetchedFrame& frame) = 0;
  /// fetch() and decode().
  bool next(Photograph& frame);

  /// Has the next fetch() give frame `index` (0 ≤ index ≤ frame_count()), the same as after that
  /// many calls of fetch(). Forward and backward; a video may have to decode frames before it, all
  /// of them where VideoReader::go_to_start() knows none to begin with.
  virtual void skip_to(int index) = 0;

  /// Frames there are in all. Some containers promise a few more than their videos have.
  [[nodiscard]] virtual int frame_count() const = 0;

  /// Names frame `index`, counted from 0: the file, or "video.mp4 frame 12".
  [[nodiscard]] virtual std::string describe(int index) const = 0;

  /// Number in the name of frame `index`'s file, the last one of several ("left_0012.png": 12);
  /// empty where there is none, and for videos.
  [[nodiscard]] virtual std::optional<long long> number_of(int index) const = 0;

  /// Empty for image files.
  [[nodiscard]] virtual std::optional<FrameRate> frame_rate() const = 0;

  /// The video file, which may hold sound; empty for image files.
  [[nodiscard]] virtual std::filesystem::path video_file() const = 0;

  /// The files that frames are read from.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const { return {video_file()}; }

  /// What the frames are read from, so that a later run can tell whether it is still the same: one
  /// line of kind, name, number of files, bytes and a hash of all names, sizes and times of change.
  [[nodiscard]] virtual std::string identity() const = 0;
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
