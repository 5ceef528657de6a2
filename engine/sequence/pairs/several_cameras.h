#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/two_camera_pairs.h"

namespace vantage {

/// Pairs of two cameras with the frames of more cameras beside them (FramePair::more).
class SeveralCameras final : public PairSource {
 public:
  /// `pairs` have the pairing of all cameras.
  SeveralCameras(std::unique_ptr<TwoCameraPairs> pairs,
                 std::vector<std::unique_ptr<FrameSource>> more);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override { pairs_->skip_to(index); }
  [[nodiscard]] int pair_count() const override { return pairs_->pair_count(); }
  [[nodiscard]] int frame_of(std::size_t camera, int index) const override {
    return pairs_->frame_of(camera, index);
  }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::vector<std::string> remarks() const override { return pairs_->remarks(); }
  [[nodiscard]] Pairing pairing() const override { return pairs_->pairing(); }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return pairs_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return pairs_->frame_times();
  }
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

  std::unique_ptr<TwoCameraPairs> pairs_;
  std::vector<Camera> more_;
};

}  // namespace vantage
