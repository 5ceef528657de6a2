#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Pairs of frames of one moving camera. The earlier frame of pair i is frame i, the later one
/// frame i + |step|.
class MovingCameraPairs : public PairSource {
 public:
  /// Throws Error when there are no more than |step| frames.
  MovingCameraPairs(std::unique_ptr<FrameSource> source, int step);

  [[nodiscard]] int pair_count() const final { return source_->frame_count() - distance_; }
  [[nodiscard]] std::string describe(int index) const final;
  [[nodiscard]] std::vector<std::string> remarks() const final;
  [[nodiscard]] int unpaired_frames() const final { return 0; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const final { return source_->frame_rate(); }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const final;
  [[nodiscard]] Sound sound() const final {
    return {source_->video_file(), later_is_left_ ? distance_ : 0.0};
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const final { return source_->files(); }
  [[nodiscard]] std::vector<std::string> identities() const final { return {source_->identity()}; }

 protected:
  [[nodiscard]] FrameSource& source() { return *source_; }
  [[nodiscard]] const FrameSource& source() const { return *source_; }
  [[nodiscard]] int distance() const { return distance_; }
  [[nodiscard]] FetchedFrame& earlier(FramePair& pair) const {
    return pair.fetched[later_is_left_ ? 1 : 0];
  }
  [[nodiscard]] FetchedFrame& later(FramePair& pair) const {
    return pair.fetched[later_is_left_ ? 0 : 1];
  }

 private:
  std::unique_ptr<FrameSource> source_;
  int distance_;  // |step|
  bool later_is_left_;
};

/// Image files: each is read twice, which takes no longer than keeping frames in order.
class MovingCameraImages : public MovingCameraPairs {
 public:
  using MovingCameraPairs::MovingCameraPairs;

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override { next_index_ = index; }

 private:
  int next_index_ = 0;
};

/// A video: every frame is decoded once and its picture kept until it has been the earlier one of a
/// pair. Each of its two pairs makes its own photograph of it.
class MovingCameraVideo : public MovingCameraPairs {
 public:
  MovingCameraVideo(std::unique_ptr<FrameSource> source, int step);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] int frames_kept() const override { return static_cast<int>(kept_.size()); }

 private:
  struct KeptFrame {
    FetchedFrame fetched;
    std::string problem;  ///< of a bad frame
  };

  [[nodiscard]] KeptFrame& kept(int frame) {
    return kept_[static_cast<std::size_t>(frame) % kept_.size()];
  }
  /// Fetches the next frame into kept_; false after the last one.
  bool keep_next();

  std::vector<KeptFrame> kept_;  // |step| + 1 of them
  int next_index_ = 0;           // of pairs, and the first kept frame
  int kept_end_ = 0;             // frame after the last kept one
};

/// Throws Error when there are no more than |step| frames.
std::unique_ptr<PairSource> make_moving_camera_pairs(std::unique_ptr<FrameSource> source, int step);

}  // namespace vantage
