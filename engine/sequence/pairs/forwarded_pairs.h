#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// The pairs of another source, all as they are: for sources that change something of them.
class ForwardedPairs : public PairSource {
 public:
  bool fetch(FramePair& pair) override { return source_->fetch(pair); }
  void skip_to(int index) override { source_->skip_to(index); }
  [[nodiscard]] int pair_count() const override { return source_->pair_count(); }
  [[nodiscard]] bool is_stream() const override { return source_->is_stream(); }
  [[nodiscard]] FrameRange repeatable_pairs() const override { return source_->repeatable_pairs(); }
  void forget_start() override { source_->forget_start(); }
  bool is_ready(std::chrono::milliseconds longest) override { return source_->is_ready(longest); }
  [[nodiscard]] int dropped_pairs() const override { return source_->dropped_pairs(); }
  [[nodiscard]] FrameRange pairs_of(FrameRange input_frames) const override {
    return source_->pairs_of(input_frames);
  }
  [[nodiscard]] int index_of(int pair) const override { return source_->index_of(pair); }
  [[nodiscard]] int frame_of(std::size_t camera, int index) const override {
    return source_->frame_of(camera, index);
  }
  [[nodiscard]] int input_frames() const override { return source_->input_frames(); }
  [[nodiscard]] int frames_kept() const override { return source_->frames_kept(); }
  [[nodiscard]] PairDetails details(int index) const override { return source_->details(index); }
  [[nodiscard]] std::string describe(int index) const override { return source_->describe(index); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return source_->remarks(); }
  [[nodiscard]] Pairing pairing() const override { return source_->pairing(); }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return source_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return source_->frame_times();
  }
  [[nodiscard]] FilmFormat film_format() const override { return source_->film_format(); }
  [[nodiscard]] Sound sound() const override { return source_->sound(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return source_->files();
  }
  [[nodiscard]] std::vector<std::string> identities() const override {
    return source_->identities();
  }

 protected:
  void make_images(FramePair& pair) const override { source_->decode(pair); }
  explicit ForwardedPairs(std::unique_ptr<PairSource> source) : source_(std::move(source)) {}

  std::unique_ptr<PairSource> source_;
};

}  // namespace vantage
