#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/io/video/frame_source.h"
#include "engine/io/video/video_io.h"

namespace vantage {

/// The frames of a video file. fetch() decodes them, each from those before it, and
/// FetchedFrame::decode() converts them to photographs. Damage loses the frames up to the next
/// known random access point.
class VideoFrames : public FrameSource {
 public:
  /// Throws Error as VideoReader does.
  explicit VideoFrames(std::string name);

  bool fetch(FetchedFrame& frame) override;
  /// Decodes all frames on the way if there is no known random access point.
  void skip_to(int index) override;
  [[nodiscard]] int frame_count() const override { return frame_count_; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return reader_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return reader_->frame_times();
  }
  [[nodiscard]] FilmFormat film_format() const override { return reader_->film_format(); }
  [[nodiscard]] std::optional<FilmStart> start() const override { return reader_->start(); }
  [[nodiscard]] std::filesystem::path video_file() const override { return name_; }
  [[nodiscard]] std::string identity() const override;

 private:
  std::string name_;
  std::unique_ptr<VideoReader> reader_;
  int frame_count_;
  int next_index_ = 0;
  /// Records the problem of the next frame.
  void note_damage(const std::string& problem);

  int next_good_ = 0;   ///< frames before it are lost to damage; the reader is there
  std::string damage_;  ///< problem of the last bad frame that was not itself after damage
};

}  // namespace vantage
