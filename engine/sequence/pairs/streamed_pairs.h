#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/forwarded_pairs.h"

namespace vantage {

/// The pairs of a source that goes forward only. The first ones are held, so that they can be
/// looked at before they are processed: up to `max_held` and up to 256 MiB, at least one.
class StreamedPairs final : public ForwardedPairs {
 public:
  static constexpr int kMaxHeld = 16;

  explicit StreamedPairs(std::unique_ptr<PairSource> source, int max_held = kMaxHeld)
      : ForwardedPairs(std::move(source)), max_held_(max_held) {}

  bool fetch(FramePair& pair) override;
  /// The first pair that is fetched is the first that is held. Pairs before it are dropped.
  void skip_to(int index) override { next_index_ = index; }
  [[nodiscard]] bool is_stream() const override { return true; }
  [[nodiscard]] FrameRange repeatable_pairs() const override {
    return {first_held_, first_held_ + limit_};
  }
  void forget_start() override { holds_ = false; }
  bool is_ready(std::chrono::milliseconds longest) override {
    return is_held(next_index_) || source_->is_ready(longest);
  }

 private:
  /// What fetch() gave, or threw.
  struct Held {
    std::array<FetchedFrame, 2> fetched;
    int index = 0;
    std::vector<std::string> remarks;
    std::exception_ptr problem;
  };
  [[nodiscard]] bool is_held(int index) const {
    return index >= first_held_ && index < first_held_ + static_cast<int>(held_.size());
  }
  bool fetch_from_source(FramePair& pair);
  bool fetch_and_hold(FramePair& pair);
  void give_held(FramePair& pair);

  int max_held_;
  int next_index_ = 0;
  int source_index_ = 0;  ///< of the pair that the source gives next
  std::deque<Held> held_;
  int first_held_ = 0;
  int limit_ = 1;
  bool holds_ = true;
};

}  // namespace vantage
