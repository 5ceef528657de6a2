#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "engine/io/files/atomic_file.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/libav.h"

struct AVCodecParameters;
struct AVRational;

namespace vantage {

/// Writes a video file: MP4, Matroska (.mkv) or MOV by its extension. MP4 and MOV have their index
/// first, so that browsers can start before they have all of it. Contains no dates or versions, so
/// the bytes depend on the input only. The file appears under its name at finish(); without it
/// nothing is left. Thread rule: one thread at a time.
class VideoMuxer {
 public:
  /// Throws Error when the file cannot be written.
  explicit VideoMuxer(const std::filesystem::path& path);
  VideoMuxer(const VideoMuxer&) = delete;
  VideoMuxer& operator=(const VideoMuxer&) = delete;
  ~VideoMuxer();

  /// Adds a stream before begin(), the video first. is_steady: all its frames have the same length,
  /// which the unit of the video then is. Returns its index.
  int add_stream(const AVCodecParameters& parameters, AVRational time_unit, bool is_steady = true);
  void begin();
  /// Writes `packet`, whose times are in `time_unit`, to stream `stream`; the packet is empty
  /// afterwards. Packets of a stream come in decoding order, those of several streams roughly by
  /// their times. Throws Error when the disk is full.
  void write(AVPacket& packet, int stream, AVRational time_unit);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The file will have another name of the same folder.
  void rename(const std::filesystem::path& path);
  /// Ends the file, checks that it can be read as a video of `frames` frames, and gives it its
  /// name.
  void finish(int frames);

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  struct Free {
    void operator()(AVFormatContext* output) const noexcept;
  };

  std::filesystem::path path_;
  bool is_matroska_;
  std::int64_t last_time_ = -1;  ///< of the video, in Matroska's milliseconds
  AtomicFile file_;
  // Declared after the file, so that it closes it before the file is removed.
  std::unique_ptr<AVFormatContext, Free> output_;
};

}  // namespace vantage
