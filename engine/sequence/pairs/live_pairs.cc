#include "engine/sequence/pairs/live_pairs.h"

#include <fmt/format.h>

#include <cstddef>

#include "engine/error.h"

namespace vantage {

LivePairs::~LivePairs() {
  {
    const std::scoped_lock lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
  if (reader_.joinable()) {
    reader_.join();
  }
}

void LivePairs::forget_start() {
  source_->forget_start();
  reader_ = std::thread([this] { read_all(); });
}

void LivePairs::read_all() {
  FramePair incoming;
  std::unique_lock lock(mutex_, std::defer_lock);
  for (bool has_pair = true; has_pair;) {
    std::exception_ptr problem;
    try {
      has_pair = source_->fetch(incoming);
    } catch (const Error&) {
      problem = std::current_exception();
    } catch (...) {
      problem = std::current_exception();
      has_pair = false;
    }
    lock.lock();
    if (problem) {
      problem_ = problem;
    } else if (has_pair) {
      incoming.arrival = std::chrono::steady_clock::now();
      incoming.details.name = fmt::format("{:06}", incoming.index);
      dropped_ += has_newest_ ? 1 : 0;
      std::swap(incoming, newest_);
      has_newest_ = true;
    }
    has_ended_ = !has_pair;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !problem_ || has_ended_ || is_closed_; });
    has_pair = has_pair && !is_closed_;
    lock.unlock();
  }
}

bool LivePairs::fetch(FramePair& pair) {
  if (!reader_.joinable()) {
    return source_->fetch(pair);
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return has_news(); });
  if (has_newest_) {
    std::swap(pair, newest_);
    has_newest_ = false;
    numbers_[static_cast<std::size_t>(fetched_++ % 2)] = pair.index;
    return true;
  }
  if (problem_) {
    const int last = fetched_ == 0 ? -1 : numbers_[static_cast<std::size_t>((fetched_ - 1) % 2)];
    numbers_[static_cast<std::size_t>(fetched_++ % 2)] = last + 1;
    changed_.notify_all();
    std::rethrow_exception(std::exchange(problem_, nullptr));
  }
  return false;
}

void LivePairs::skip_to(int index) {
  if (!reader_.joinable()) {
    source_->skip_to(index);
  }
}

bool LivePairs::is_ready(std::chrono::milliseconds longest) {
  if (!reader_.joinable()) {
    return source_->is_ready(longest);
  }
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, longest, [&] { return has_news(); });
}

int LivePairs::dropped_pairs() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

std::string LivePairs::describe(int index) const {
  if (!reader_.joinable()) {
    return source_->describe(index);
  }
  const std::scoped_lock lock(mutex_);
  return source_->describe(numbers_[static_cast<std::size_t>(index % 2)]);
}

}  // namespace vantage
