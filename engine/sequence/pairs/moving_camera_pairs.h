#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Which frames of one sequence are pairs.
struct SuccessiveFrames {
  int step = 1;      ///< from the left frame to the right one; below 0: the right one is earlier
  int distance = 1;  ///< from a pair to the next: 1, or 2 where frames take turns (StereoLayout)
};

/// Pairs of frames of one moving camera, or of a film whose left and right pictures take turns. The
/// earlier frame of pair i is frame i · distance, the later one |step| frames after it.
class MovingCameraPairs : public PairSource {
 public:
  /// Throws Error when there are no more than |step| frames.
  MovingCameraPairs(std::unique_ptr<FrameSource> source, SuccessiveFrames pairs);

  [[nodiscard]] int pair_count() const final {
    return (source_->frame_count() - distance_ - 1) / between_pairs_ + 1;
  }
  [[nodiscard]] std::string describe(int index) const final;
  [[nodiscard]] std::vector<std::string> remarks() const final;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const final;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const final;
  [[nodiscard]] FilmFormat film_format() const final { return source_->film_format(); }
  [[nodiscard]] Sound sound() const final {
    return {source_->video_file(), static_cast<double>(first_left()) / between_pairs_};
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const final { return source_->files(); }
  [[nodiscard]] std::vector<std::string> identities() const final { return {source_->identity()}; }

 protected:
  [[nodiscard]] FrameSource& source() { return *source_; }
  [[nodiscard]] const FrameSource& source() const { return *source_; }
  [[nodiscard]] int distance() const { return distance_; }
  /// Frames of pair `index`.
  [[nodiscard]] int earlier_frame(int index) const { return index * between_pairs_; }
  [[nodiscard]] int later_frame(int index) const { return earlier_frame(index) + distance_; }
  [[nodiscard]] bool takes_turns() const { return between_pairs_ > 1; }
  [[nodiscard]] FetchedFrame& earlier(FramePair& pair) const {
    return pair.fetched[later_is_left_ ? 1 : 0];
  }
  [[nodiscard]] FetchedFrame& later(FramePair& pair) const {
    return pair.fetched[later_is_left_ ? 0 : 1];
  }

 private:
  /// Left frame of pair 0. Pictures that take turns are shown as one.
  [[nodiscard]] int first_left() const { return later_is_left_ && !takes_turns() ? distance_ : 0; }

  std::unique_ptr<FrameSource> source_;
  int distance_;  // |step|
  int between_pairs_;
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

/// A video or a stream: every frame is decoded once and its picture kept until it has been the
/// earlier one of a pair. Each of its two pairs makes its own photograph of it.
class MovingCameraVideo : public MovingCameraPairs {
 public:
  MovingCameraVideo(std::unique_ptr<FrameSource> source, SuccessiveFrames pairs);

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
  int next_index_ = 0;           // of pairs
  int kept_end_ = 0;             // frame after the last kept one
};

/// Throws Error when there are no more than |step| frames.
std::unique_ptr<PairSource> make_moving_camera_pairs(std::unique_ptr<FrameSource> source,
                                                     SuccessiveFrames pairs);

}  // namespace vantage
