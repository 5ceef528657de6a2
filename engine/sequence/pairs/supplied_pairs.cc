#include "engine/sequence/pairs/supplied_pairs.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

/// How often who waits for a pair looks whether it is interrupted.
constexpr std::chrono::milliseconds kLookInterval(20);

}  // namespace

bool PairQueue::put(Pair pair) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < room_ || is_closed_; });
  if (is_closed_) {
    return false;
  }
  waiting_.push_back(std::move(pair));
  changed_.notify_all();
  return true;
}

void PairQueue::end() {
  const std::scoped_lock lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

void PairQueue::close() {
  const std::scoped_lock lock(mutex_);
  has_ended_ = true;
  is_closed_ = true;
  waiting_.clear();
  changed_.notify_all();
}

bool PairQueue::take(Pair& pair) {
  while (!is_ready(kLookInterval)) {
    scheduler::check_interruption();
  }
  const std::scoped_lock lock(mutex_);
  if (waiting_.empty()) {
    return false;
  }
  pair = std::move(waiting_.front());
  waiting_.pop_front();
  changed_.notify_all();
  return true;
}

bool PairQueue::is_ready(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, longest, [&] { return has_news(); });
}

bool SuppliedPairs::fetch(FramePair& pair) {
  PairQueue::Pair taken;
  if (!queue_->take(taken)) {
    return false;
  }
  pair.index = next_index_++;
  pair.remarks.clear();
  for (FetchedFrame& frame : pair.fetched) {
    frame.file.clear();
    frame.picture = {};
    frame.remarks.clear();
  }
  pair.fetched[0].photograph = std::move(taken.first);
  pair.fetched[1].photograph = std::move(taken.second);
  return true;
}

void SuppliedPairs::skip_to(int index) {
  if (index < next_index_) {
    throw Error(fmt::format("{}: is over, expected pairs in order", describe(index)));
  }
  PairQueue::Pair dropped;
  while (next_index_ < index && queue_->take(dropped)) {
    ++next_index_;
  }
}

std::string SuppliedPairs::describe(int index) const { return fmt::format("pair {}", index); }

}  // namespace vantage
