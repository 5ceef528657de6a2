#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Pairs stored as one picture each.
class PackedPairs : public PairSource {
 public:
  PackedPairs(std::unique_ptr<FrameSource> source, StereoPacking packing);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] int pair_count() const override { return source_->frame_count(); }
  [[nodiscard]] std::string describe(int index) const override { return source_->describe(index); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return source_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return source_->frame_times();
  }
  /// Halves of half size are stretched, so pixels keep their shape.
  [[nodiscard]] FilmFormat film_format() const override { return source_->film_format(); }
  [[nodiscard]] Sound sound() const override { return {source_->video_file(), 0.0}; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return source_->files();
  }
  [[nodiscard]] std::vector<std::string> identities() const override {
    return {source_->identity()};
  }

 private:
  void make_images(FramePair& pair) const override;
  std::unique_ptr<FrameSource> source_;
  StereoPacking packing_;
  int next_index_ = 0;
};

}  // namespace vantage
