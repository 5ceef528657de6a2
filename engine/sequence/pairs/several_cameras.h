#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/two_camera_pairs.h"

namespace vantage {

/// Pairs of two cameras with the frames of more cameras beside them (FramePair::more): their frame
/// i belongs to frame i of the left camera.
class SeveralCameras final : public PairSource {
 public:
  /// Throws Error when no frame has a partner in all of `more`.
  SeveralCameras(std::unique_ptr<TwoCameraPairs> pairs,
                 std::vector<std::unique_ptr<FrameSource>> more);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] int pair_count() const override { return pair_count_; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] int unpaired_frames() const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override;
  [[nodiscard]] FilmFormat film_format() const override { return pairs_->film_format(); }
  [[nodiscard]] Sound sound() const override { return pairs_->sound(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override;
  [[nodiscard]] std::vector<std::string> identities() const override;

 private:
  void make_images(FramePair& pair) const override;
  /// A camera, and the frame of the result of its next fetch().
  struct Camera {
    std::unique_ptr<FrameSource> source;
    int next_frame = 0;
  };
  /// Frames of a camera that belong to pairs of the first two, or would.
  [[nodiscard]] int frames_of(const Camera& camera) const {
    return camera.source->frame_count() - pairs_->first_left();
  }

  std::unique_ptr<TwoCameraPairs> pairs_;
  std::vector<Camera> more_;
  int pair_count_;
};

}  // namespace vantage
