#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sequence/pairs/forwarded_pairs.h"

namespace vantage {

/// Some pairs of another source: pair i is its pair first + i · step.
class EveryNthPair final : public ForwardedPairs {
 public:
  /// 0 ≤ first, 1 ≤ step. Throws Error when the source has no pair `first`.
  EveryNthPair(std::unique_ptr<PairSource> source, int first, int step);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override { next_index_ = index; }
  [[nodiscard]] int pair_count() const override { return pair_count_; }
  [[nodiscard]] FrameRange repeatable_pairs() const override { return {0, pair_count_}; }
  [[nodiscard]] FrameRange pairs_of(FrameRange input_frames) const override;
  [[nodiscard]] int index_of(int pair) const override {
    return source_->index_of(source_index(pair));
  }
  [[nodiscard]] std::string describe(int index) const override {
    return source_->describe(source_index(index));
  }
  [[nodiscard]] PairDetails details(int index) const override {
    return source_->details(source_index(index));
  }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override;
  [[nodiscard]] Sound sound() const override;

 private:
  [[nodiscard]] int source_index(int index) const { return first_ + index * step_; }

  int first_;
  int step_;
  int pair_count_;
  int next_index_ = 0;
};

}  // namespace vantage
