#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/image/photograph.h"
#include "engine/io/frame_rate.h"
#include "engine/io/video_picture.h"

namespace vantage {

/// Reads the frames of a video file in order of presentation, in the size they are stored in (a
/// rotation flag is ignored): RGB, 8-bit, or 16-bit where the stream has more bits. Grey streams
/// have one channel, as far as their decoder tells. Colours are converted by the matrix, range and
/// place of chroma the stream is flagged with, and rounded; unspecified, they are BT.601 below 720
/// rows, BT.709 from there, with limited range.
/// Half as many threads as there are processors decode, up to four; they change nothing, not even
/// which frame is found damaged.
/// Thread rule: one thread at a time; different readers are independent.
class VideoReader {
 public:
  /// Throws Error when the file is missing, not a video, an MP4 or MOV whose index is cut off, or
  /// has frames of absurd size. Other files that are cut off can be read up to the cut.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  /// Empty where the container does not say.
  [[nodiscard]] std::optional<FrameRate> frame_rate() const;
  /// Frames the index of an MP4 or MOV lists; in other containers the packets of the video are
  /// counted, for which the whole file is read. Interlaced videos may have fewer, and recordings
  /// that begin in mid-programme, by up to a fiftieth. Where the packets of a file that is cut off
  /// are counted, the frame that is cut counts.
  [[nodiscard]] int frame_count() const;

  /// Decodes the next frame, whose picture any thread may make a photograph of; false after the
  /// last one. Throws Error naming the frame when it is damaged or cut off, or the file ends before
  /// the frames it promised: the video ends there, as later frames are made from the damaged one.
  bool read(VideoPicture& picture);
  /// Likewise, and makes the photograph, whose memory is reused. A frame that cannot be converted
  /// is an Error too, after which the next one can be read.
  bool read(Photograph& frame);
  /// read() without the result.
  bool skip();

  /// Goes to the last frame of first..last that can be decoded without those before it, which is
  /// then the next one read; the same frames follow as from the beginning. Frame 0 is
  /// one, others are known of H.264 and of codings without references, in MP4 and MOV. Empty, and
  /// nothing happens, where there is none. Leaves damage behind. Throws Error.
  std::optional<int> go_to_start(int first, int last);
  /// Likewise to the first such frame from `first` on.
  std::optional<int> go_to_next_start(int first);

  /// Frames that should lie between the last frame read and the one before it, by their times and
  /// the frame rate; 0 where nothing is missing or times are unknown.
  [[nodiscard]] int frames_missing() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// How videos are encoded.
struct VideoEncoding {
  FrameRate rate = {};
  /// H.264 constant rate factor, 0 (lossless but for the colour conversion) to 51 (worst).
  int crf = 18;
};

/// Writes an MP4 (H.264, yuv420p: what browsers play). H.264 in this format has even sizes only: an
/// odd last column or row is repeated once. The file appears under its name at finish(); without
/// it nothing is left. One thread encodes, so that the bytes depend on the frames only.
/// Thread rule: one thread at a time.
class VideoWriter {
 public:
  /// `path` ends in .mp4; width and height in 2..16384 pixels. Throws UsageError for values
  /// outside, Error when the file cannot be written.
  VideoWriter(const std::filesystem::path& path, int width, int height,
              const VideoEncoding& encoding);
  ~VideoWriter();

  /// Appends a frame: 8-bit, 16-bit or float (0..1, clamped), 1, 3 or 4 channels (alpha is
  /// dropped). Throws Error when its size is not the one given at construction, or the disk is
  /// full.
  void write(const Photograph& frame);

  /// Encodes what the encoder has held back and gives back its memory: no frame may follow.
  /// finish() then has nothing left to do but to wait for the disk.
  void end_encoding();

  /// Ends the file, checks that it reads back as a video of as many frames as were written, and
  /// gives it its name. Call it once, after at least one frame. Throws Error.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
