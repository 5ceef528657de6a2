#pragma once

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/pairs/supplied_pairs.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "scheduler/interruption.h"

namespace vantage::python {

/// Pairs of arrays on their way from a thread of Python to a loop. Thread rule: put() one at a
/// time.
class PairFeed {
 public:
  /// `room`: pairs that may wait.
  PairFeed(std::size_t room, ChannelOrder order)
      : queue_(std::make_shared<PairQueue>(room)), order_(order) {}

  /// Copies the images, then waits for room. False: nobody takes them.
  bool put(const pybind11::object& left, const pybind11::object& right) {
    const int number = count_;
    const std::array sides = {PixelArray(left, order_, fmt::format("left of pair {}", number)),
                              PixelArray(right, order_, fmt::format("right of pair {}", number))};
    const ReleasedGil release;
    PairQueue::Pair pair = {sides[0].copy(), sides[1].copy()};
    if (pair.first.width() != pair.second.width() || pair.first.height() != pair.second.height()) {
      throw Error(fmt::format("left of pair {} is {}x{} but right is {}x{}, expected equal sizes",
                              number, pair.first.width(), pair.first.height(), pair.second.width(),
                              pair.second.height()));
    }
    ++count_;
    return queue_->put(std::move(pair));
  }
  void end() { queue_->end(); }
  void close() { queue_->close(); }
  /// Whether there is a first pair, which is waited for.
  [[nodiscard]] bool has_pairs() const {
    while (!queue_->is_ready(std::chrono::milliseconds(20))) {
      scheduler::check_interruption();
    }
    return count_ > 0;
  }
  [[nodiscard]] const std::shared_ptr<PairQueue>& queue() const { return queue_; }

 private:
  std::shared_ptr<PairQueue> queue_;
  ChannelOrder order_;
  std::atomic<int> count_ = 0;
};

}  // namespace vantage::python
