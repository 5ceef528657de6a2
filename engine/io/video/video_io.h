#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/image/photograph.h"
#include "engine/io/video/film_format.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_coding.h"
#include "engine/io/video/video_picture.h"

namespace vantage {

/// Reads the frames of a video file in order of presentation, as stored unless set_handling() says
/// otherwise: RGB, 8-bit, or 16-bit if the stream has more bits. Grey streams have one channel,
/// if their decoder reports it. Colours are converted by the flagged matrix, range and chroma
/// position, and rounded; if unspecified, they are BT.601 below 720 rows, else BT.709, with limited
/// range. Half as many threads as processors decode, up to four; they do not affect the result, not
/// even which frame is found damaged. Thread rule: one thread at a time; different readers are
/// independent.
class VideoReader {
 public:
  /// Throws Error when the file is missing, not a video, an MP4 or MOV with a truncated index, or
  /// has implausibly large frames. Other truncated files can be read up to the cut.
  explicit VideoReader(const std::filesystem::path& path, int track = kMainVideo);
  ~VideoReader();

  /// Of the pictures that follow.
  void set_handling(const PictureHandling& handling);

  /// As stored.
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  /// Empty if the container does not specify it.
  [[nodiscard]] std::optional<FrameRate> frame_rate() const;
  /// Empty if the rate is constant, and where not all times are known, as in interlaced video.
  [[nodiscard]] const std::optional<FrameTimes>& frame_times() const;
  /// What the film states of its pictures.
  [[nodiscard]] const FilmFormat& film_format() const;
  /// Empty if it is not known when each frame is shown.
  [[nodiscard]] std::optional<FilmStart> start() const;
  /// Frames in the index of an MP4 or MOV; in other containers the packets of the video are
  /// counted, which reads the whole file. Interlaced videos may have fewer, as may recordings that
  /// start mid-programme, by up to a fiftieth. In a truncated file without index, the incomplete
  /// frame counts.
  [[nodiscard]] int frame_count() const;

  /// Decodes the next frame, whose picture any thread may convert to a photograph; false after the
  /// last one. Throws Error naming the frame when it is damaged or truncated, or the file ends
  /// before the promised frames: the video ends there, because later frames depend on the damaged
  /// one.
  bool read(VideoPicture& picture);
  /// As above, and converts it to the photograph, whose memory is reused. A frame that cannot be
  /// converted is an Error too, after which the next one can be read.
  bool read(Photograph& frame);
  /// read() without the result.
  bool skip();

  /// Seeks to the last frame of first..last that can be decoded without those before it; the next
  /// read() returns it, and the same frames follow as from the start. Frame 0 is one, others are
  /// known for H.264 and intra-only codecs, in MP4 and MOV. Returns empty and does nothing if there
  /// is none. Continues after damage. Throws Error.
  std::optional<int> go_to_start(int first, int last);
  /// As go_to_start(), to the first such frame from `first` on.
  std::optional<int> go_to_next_start(int first);

  /// Number of frames missing between the last frame read and the one before it, by their times and
  /// the frame rate; 0 if nothing is missing or times are unknown.
  [[nodiscard]] int frames_missing() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Encoding parameters of videos.
struct VideoEncoding {
  FrameRate rate = {};
  /// Constant rate factor of H.264 and HEVC, 0 (best) to 51 (worst).
  int crf = 18;
  VideoCoding coding = VideoCoding::kH264;
  /// Of the film that the pictures are made of: the file states its pixels' shape and, of codings
  /// of colours, written_colours().
  FilmFormat format = {};
};

/// Writes an MP4 (H.264, yuv420p, for browsers), or another coding. All but FFV1 have even sizes
/// only: an odd last column or row is repeated once. The file appears under its name at finish();
/// without it nothing is left. Each VideoCodingTraits::group_frames frames are encoded by an
/// encoder of their own, on one thread at a time, so the bytes depend on the frames only, and
/// groups can be encoded side by side.
/// Thread rule: one thread at a time; encode_some() and frames_waiting() by any. Different writers
/// are independent.
class VideoWriter {
 public:
  /// `path` ends in .mp4, or what else the coding's files end in; width and height in 2..16384
  /// pixels. Throws UsageError for values outside, Error when the file cannot be written.
  VideoWriter(const std::filesystem::path& path, int width, int height,
              const VideoEncoding& encoding);
  ~VideoWriter();

  /// Appends a frame and encodes it: 8-bit, 16-bit or float (0..1, clamped), 1, 3 or 4 channels
  /// (alpha is dropped); of a grey coding 16-bit with one channel. Throws Error when its size is
  /// not the one given at construction, or the disk is full.
  void write(const Photograph& frame);

  /// Appends a frame of make_frame_conversion(), whose pixels must not change any more; it waits
  /// until some thread encodes it. Throws the Error of an earlier one.
  void add(LibavFrame frame);
  /// Encodes a frame, or goes on with those that an encoder holds back, of the first group that no
  /// other thread works on; false where there is none. An encoder needs more memory than the frames
  /// that wait: another one is opened when a third of a group waits. add() and finish() throw its
  /// errors.
  bool encode_some();
  [[nodiscard]] int frames_waiting() const;

  /// No frame may follow. Throws Error when there was none.
  void end();

  /// The file will have another name of the same folder. Throws Error.
  void rename(const std::filesystem::path& path);

  /// Encodes what waits, or waits for who does, ends the file, checks that it can be read as a
  /// video with all frames, and gives it its name. Call it once, after at least one frame. Throws
  /// Error.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
