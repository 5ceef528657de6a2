#include "engine/sequence/pairs/streamed_pairs.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::size_t kMaxHeldBytes = std::size_t{256} << 20;

/// The same frame again: a picture that is still to be converted, or a photograph.
void copy_frame(const FetchedFrame& frame, FetchedFrame& copy) {
  copy.file.clear();
  copy.frames_missing = 0;
  copy.picture = frame.picture.share();
  copy.remarks = frame.remarks;
  if (frame.picture.is_empty()) {
    copy.photograph = std::visit([](const auto& image) { return Photograph{image.copy()}; },
                                 frame.photograph.pixels);
  }
}

}  // namespace

bool StreamedPairs::fetch_from_source(FramePair& pair) {
  if (std::exchange(source_index_, next_index_ + 1) != next_index_) {
    source_->skip_to(next_index_);
  }
  ++next_index_;
  return source_->fetch(pair);
}

bool StreamedPairs::fetch_and_hold(FramePair& pair) {
  if (held_.empty()) {
    first_held_ = next_index_;
  }
  Held held;
  const bool wants_right = std::exchange(pair.wants_right, true);  // who looks later may want it
  try {
    const bool is_there = fetch_from_source(pair);
    pair.wants_right = wants_right;
    if (!is_there) {
      return false;
    }
    const std::size_t bytes =
        std::max<std::size_t>(1, pair.fetched[0].picture.bytes() + pair.fetched[1].picture.bytes());
    limit_ = static_cast<int>(
        std::clamp<std::size_t>(kMaxHeldBytes / bytes, 1, static_cast<std::size_t>(max_held_)));
    copy_frame(pair.fetched[0], held.fetched[0]);
    copy_frame(pair.fetched[1], held.fetched[1]);
    held.remarks = pair.remarks;
  } catch (const Error&) {
    pair.wants_right = wants_right;
    held.problem = std::current_exception();
  }
  held.index = pair.index;
  const std::exception_ptr problem = held.problem;
  held_.push_back(std::move(held));
  if (problem) {
    std::rethrow_exception(problem);
  }
  return true;
}

void StreamedPairs::give_held(FramePair& pair) {
  const int place = next_index_++ - first_held_;
  const Held& held = held_[static_cast<std::size_t>(place)];
  const std::exception_ptr problem = held.problem;
  copy_frame(held.fetched[0], pair.fetched[0]);
  copy_frame(held.fetched[1], pair.fetched[1]);
  pair.index = held.index;
  pair.remarks = held.remarks;
  if (!holds_) {
    held_.erase(held_.begin(), held_.begin() + place + 1);
    first_held_ = next_index_;
  }
  if (problem) {
    std::rethrow_exception(problem);
  }
}

bool StreamedPairs::fetch(FramePair& pair) {
  const auto held_end = first_held_ + static_cast<int>(held_.size());
  if (is_held(next_index_)) {
    give_held(pair);
    return true;
  }
  const bool has_room =
      held_.empty() || (next_index_ == held_end && next_index_ < first_held_ + limit_);
  return holds_ && has_room ? fetch_and_hold(pair) : fetch_from_source(pair);
}

}  // namespace vantage
