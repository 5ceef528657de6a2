#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "engine/sequence/pairs/forwarded_pairs.h"

namespace vantage {

/// The pairs of a stream as they come: after forget_start() a thread reads it all the time, so that
/// no pair waits in a pipe or a socket, and fetch() gives the newest one. A pair is dropped when
/// the next one comes before it is fetched. The last pair of the stream and bad ones are not; after
/// a bad one the thread waits until it is known.
class LivePairs final : public ForwardedPairs {
 public:
  explicit LivePairs(std::unique_ptr<PairSource> source) : ForwardedPairs(std::move(source)) {}
  /// Returns when the source has ended, or given its next pair.
  ~LivePairs() override;
  LivePairs(const LivePairs&) = delete;
  LivePairs& operator=(const LivePairs&) = delete;

  /// FramePair::index is the number of the pair in the stream, which names its files, too.
  bool fetch(FramePair& pair) override;
  /// Without effect once forget_start() was called.
  void skip_to(int index) override;
  void forget_start() override;
  bool is_ready(std::chrono::milliseconds longest) override;
  [[nodiscard]] int dropped_pairs() const override;
  /// `index`: of the results, one of the last two that were fetched.
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] const WhiteLevel& white_level() const override { return source_->white_level(); }

 private:
  void read_all();
  [[nodiscard]] bool has_news() const { return has_newest_ || problem_ || has_ended_; }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by it.
  FramePair newest_;
  bool has_newest_ = false;
  std::exception_ptr problem_;
  bool has_ended_ = false;
  bool is_closed_ = false;
  int dropped_ = 0;
  int fetched_ = 0;                  ///< pairs
  std::array<int, 2> numbers_ = {};  ///< in the stream, of the last two of these

  std::thread reader_;  ///< from forget_start() on it alone uses the source
};

}  // namespace vantage
