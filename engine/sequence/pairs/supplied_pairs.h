#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Pairs on their way from a caller in this process to a run. Thread rule: any thread.
class PairQueue {
 public:
  using Pair = std::pair<Photograph, Photograph>;  ///< left and right

  /// `room`: pairs that may wait in it, at least 1.
  explicit PairQueue(std::size_t room) : room_(room) {}

  /// Waits for room; false: nobody takes pairs any longer.
  bool put(Pair pair);
  /// There are no more pairs.
  void end();
  /// Nobody takes pairs any longer: put() and take() return false from here on.
  void close();
  /// Waits for a pair; false after the last one. An InterruptibleScope ends the wait.
  bool take(Pair& pair);
  /// Whether take() need not wait, after at most `longest`.
  bool is_ready(std::chrono::milliseconds longest);

 private:
  [[nodiscard]] bool has_news() const { return !waiting_.empty() || has_ended_; }

  std::size_t room_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Pair> waiting_;
  bool has_ended_ = false;
  bool is_closed_ = false;
};

/// The pairs of a queue. Their number is known when they end.
class SuppliedPairs final : public PairSource {
 public:
  explicit SuppliedPairs(std::shared_ptr<PairQueue> queue) : queue_(std::move(queue)) {}

  bool fetch(FramePair& pair) override;
  /// Takes and drops the pairs up to it. Throws Error for pairs that are over.
  void skip_to(int index) override;
  [[nodiscard]] int pair_count() const override { return kUnknownFrames; }
  [[nodiscard]] bool is_stream() const override { return true; }
  bool is_ready(std::chrono::milliseconds longest) override { return queue_->is_ready(longest); }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::vector<std::string> remarks() const override { return {}; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return std::nullopt; }
  [[nodiscard]] Sound sound() const override { return {}; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::vector<std::string> identities() const override { return {"supplied pairs"}; }

 private:
  std::shared_ptr<PairQueue> queue_;
  int next_index_ = 0;
};

}  // namespace vantage
