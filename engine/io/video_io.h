#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/image/photograph.h"

namespace vantage {

/// Reads the frames of a video file in order, as 8-bit RGB, in the size they are stored in (a
/// rotation flag is ignored). Thread rule: one thread at a time; different readers are independent.
class VideoReader {
 public:
  /// Throws Error when the file is missing, not a video, cut off, or has frames of absurd size.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  /// Empty where the container does not say.
  [[nodiscard]] std::optional<double> frames_per_second() const;
  /// What the container says: exact in MP4, an estimate from the duration in some others.
  [[nodiscard]] std::optional<int> frame_count() const;

  /// Decodes the next frame into `frame`, whose memory is reused; false after the last one. Throws
  /// Error naming the frame when the file ends well before the frames it promised.
  bool read(Photograph& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes an MP4 (H.264, yuv420p: what browsers play). H.264 in this format has even sizes only: an
/// odd last column or row is repeated once. The file appears under its name at finish(); without
/// it nothing is left. Thread rule: one thread at a time.
class VideoWriter {
 public:
  /// `path` ends in .mp4; width and height in 2..16384 pixels; frames_per_second in (0, 1000].
  /// Throws UsageError for values outside, Error when the file cannot be written.
  VideoWriter(const std::filesystem::path& path, int width, int height, double frames_per_second);
  ~VideoWriter();

  /// Appends a frame: 8-bit, 16-bit or float (0..1, clamped), 1, 3 or 4 channels (alpha is
  /// dropped). Throws Error when its size is not the one given at construction.
  void write(const Photograph& frame);

  /// Ends the file, checks that it reads back as a video of as many frames as were written, and
  /// gives it its name. Call it once, after at least one frame. Throws Error.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
