#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/image/photograph_reading.h"
#include "engine/io/video/film_format.h"
#include "engine/io/video/film_properties.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/video_picture.h"

namespace vantage {

/// Number of frames of a source whose end is not known before it comes: a stream.
constexpr int kUnknownFrames = 1 << 30;

/// A frame from a source: fetched in order by one thread, decoded by any.
struct FetchedFrame {
  std::filesystem::path file;  ///< image file still to be read; empty: none
  PhotographReading reading;   ///< of `file`
  VideoPicture picture;        ///< picture still to be converted to the photograph; empty: none
  Photograph photograph;       ///< reused from frame to frame
  int frames_missing = 0;      ///< missing frames of a video between the previous one and it
  /// Remarks on a usable frame ("2 frames are missing before it").
  std::vector<std::string> remarks;

  /// Sets frames_missing, with a remark where it is not 0. `name` is that of the frame.
  void note_missing(int count, const std::string& name);
  /// Makes `photograph` from `file` or `picture`, if there is one. Thread rule: concurrently for
  /// different frames. Throws Error naming the file or frame.
  void decode();
};

/// The frames of one camera, in order. Thread rule: one thread at a time.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fetches the next frame; false after the last one, which in some videos comes a few frames
  /// before frame_count(). Throws Error naming the frame when it is bad; the next call continues
  /// with the frame after it. After a bad frame of a video others are bad too, up to the next one
  /// that can be decoded without it.
  virtual bool fetch(FetchedFrame& frame) = 0;
  /// fetch() and decode().
  bool next(Photograph& frame);

  /// Makes frame `index` (0 ≤ index ≤ frame_count()) the result of the next fetch(), identical to
  /// that after `index` calls of fetch(). Forward and backward; a video may have to decode frames
  /// before it, all of them if VideoReader::go_to_start() knows no starting point.
  virtual void skip_to(int index) = 0;

  /// Total number of frames. Some containers promise a few more than their videos have.
  [[nodiscard]] virtual int frame_count() const = 0;

  /// Names frame `index`, counted from 0: the file, or "video.mp4 frame 12".
  [[nodiscard]] virtual std::string describe(int index) const = 0;

  /// Number in the name of frame `index`'s file, the last one of several ("left_0012.png": 12);
  /// empty if there is none, and for videos.
  [[nodiscard]] virtual std::optional<long long> number_of(int /*index*/) const {
    return std::nullopt;
  }

  /// Empty for image files.
  [[nodiscard]] virtual std::optional<FrameRate> frame_rate() const { return std::nullopt; }

  /// Times of all frames of a video of variable rate; else empty.
  [[nodiscard]] virtual std::optional<FrameTimes> frame_times() const { return std::nullopt; }

  /// Of a film as it states it; of image files the default.
  [[nodiscard]] virtual FilmFormat film_format() const { return {}; }

  /// Of a film that knows when each of its frames is shown: from frame_times(), or by its rate.
  [[nodiscard]] virtual std::optional<FilmStart> start() const { return std::nullopt; }

  /// The video file, which may hold sound; empty for image files.
  [[nodiscard]] virtual std::filesystem::path video_file() const { return {}; }

  /// What a video says of itself; null for image files.
  [[nodiscard]] virtual const FilmProperties* film() const { return nullptr; }
  /// Of an interlaced video: its fields are different pictures.
  virtual void take_fields_apart() {}
  /// On all its frames, one line each: what was assumed, turned, mended.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }

  /// The files that frames are read from.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const { return {video_file()}; }

  /// Identity of the source, so that a later run can detect changes: one line of kind, name, number
  /// of files, bytes and a hash of all names, sizes and modification times.
  [[nodiscard]] virtual std::string identity() const = 0;
};

/// Opens the source `spec`; an existing file or folder of that name takes precedence:
/// - a folder: all image files in it, in natural order (frame2 before frame10), without hidden
/// ones;
/// - a file: one image, or a video; "film.mkv#1": the second one of its videos;
/// - a printf pattern with one %d or %0Nd in the file name ("left/%06d.png"): from the smallest
/// existing number to the largest; a missing number between them is a bad frame;
/// - a glob pattern in the file name ("left/*.png", with * ? and [a-z]), in natural order.
///
/// Throws Error when nothing matches, a folder holds no image, or a video does not open; UsageError
/// for a malformed pattern, or where images shall be deinterlaced.
std::unique_ptr<FrameSource> open_frame_source(const std::string& spec,
                                               const PhotographReading& reading = {});

}  // namespace vantage
