#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Some pairs of another source: pair i is its pair first + i · step.
class EveryNthPair final : public PairSource {
 public:
  /// 0 ≤ first, 1 ≤ step. Throws Error when the source has no pair `first`.
  EveryNthPair(std::unique_ptr<PairSource> source, int first, int step);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override { next_index_ = index; }
  [[nodiscard]] int pair_count() const override { return pair_count_; }
  [[nodiscard]] FrameRange pairs_of(FrameRange input_frames) const override;
  [[nodiscard]] int index_of(int pair) const override {
    return source_->index_of(source_index(pair));
  }
  [[nodiscard]] int input_frames() const override { return source_->input_frames(); }
  [[nodiscard]] int frames_kept() const override { return source_->frames_kept(); }
  [[nodiscard]] std::string describe(int index) const override {
    return source_->describe(source_index(index));
  }
  [[nodiscard]] PairDetails details(int index) const override {
    return source_->details(source_index(index));
  }
  [[nodiscard]] std::vector<std::string> remarks() const override { return source_->remarks(); }
  [[nodiscard]] int unpaired_frames() const override { return source_->unpaired_frames(); }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override;
  [[nodiscard]] Sound sound() const override;
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return source_->files();
  }
  [[nodiscard]] std::vector<std::string> identities() const override {
    return source_->identities();
  }

 private:
  void make_images(FramePair& pair) const override { source_->decode(pair); }
  [[nodiscard]] int source_index(int index) const { return first_ + index * step_; }

  std::unique_ptr<PairSource> source_;
  int first_;
  int step_;
  int pair_count_;
  int next_index_ = 0;
};

}  // namespace vantage
