#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/io/frame_source.h"
#include "engine/io/video_io.h"

namespace vantage {

/// The frames of a video file. They are decoded by fetch(), each from those before it, and become
/// photographs in FetchedFrame::decode(). Damage loses the frames up to the next one that decoding
/// is known to be able to begin with.
class VideoFrames : public FrameSource {
 public:
  /// Throws Error as VideoReader does.
  explicit VideoFrames(std::string name);

  bool fetch(FetchedFrame& frame) override;
  /// Where no frame on the way is known that decoding can begin with, all of them are decoded.
  void skip_to(int index) override;
  [[nodiscard]] int frame_count() const override { return frame_count_; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::optional<long long> number_of(int) const override { return std::nullopt; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return reader_->frame_rate();
  }
  [[nodiscard]] std::filesystem::path video_file() const override { return name_; }
  [[nodiscard]] std::string identity() const override;

 private:
  std::string name_;
  std::unique_ptr<VideoReader> reader_;
  int frame_count_;
  int next_index_ = 0;
  /// Notes what is wrong with the next frame.
  void note_damage(const std::string& problem);

  int next_good_ = 0;   ///< frames before it lie behind damage; the reader is there
  std::string damage_;  ///< what was wrong with the last bad frame that lay behind none
};

}  // namespace vantage
