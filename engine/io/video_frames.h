#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/io/frame_source.h"
#include "engine/io/video_io.h"

namespace vantage {

/// The frames of a video file. They are decoded by fetch(), each from those before it.
class VideoFrames : public FrameSource {
 public:
  /// Throws Error as VideoReader does.
  explicit VideoFrames(std::string name);

  bool fetch(FetchedFrame& frame) override;
  /// Backward opens the file anew.
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
  std::string damage_;  // what was wrong with the frame that nothing can be decoded behind
};

}  // namespace vantage
