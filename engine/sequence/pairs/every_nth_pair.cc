#include "engine/sequence/pairs/every_nth_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/error.h"

namespace vantage {

EveryNthPair::EveryNthPair(std::unique_ptr<PairSource> source, int first, int step)
    : ForwardedPairs(std::move(source)), first_(first), step_(step) {
  const int all = source_->pair_count();
  if (first >= all) {
    throw Error(fmt::format("frames are taken from frame {} on, but the input has {} (0 to {})",
                            first, all, all - 1));
  }
  pair_count_ = (all - first - 1) / step + 1;
}

bool EveryNthPair::fetch(FramePair& pair) {
  if (next_index_ >= pair_count_) {
    return false;
  }
  // The index of the pair stays that of the source, which decode() needs.
  source_->skip_to(source_index(next_index_++));
  return source_->fetch(pair);
}

FrameRange EveryNthPair::pairs_of(FrameRange input_frames) const {
  const auto pairs_before = [&](int frame) {
    const long long pairs = (static_cast<long long>(frame) - first_ + step_ - 1) / step_;
    return frame <= first_ ? 0 : static_cast<int>(std::min<long long>(pairs, pair_count_));
  };
  const FrameRange input = source_->pairs_of(input_frames);
  return {pairs_before(input.first), pairs_before(input.end)};
}

std::optional<FrameRate> EveryNthPair::frame_rate() const {
  const std::optional<FrameRate> rate = source_->frame_rate();
  return rate ? std::optional(slowed_down(*rate, step_)) : std::nullopt;
}

std::optional<FrameTimes> EveryNthPair::frame_times() const {
  const std::optional<FrameTimes> pairs = source_->frame_times();
  return pairs ? std::optional(pairs->some(first_, pair_count_, step_)) : std::nullopt;
}

PairSource::Sound EveryNthPair::sound() const {
  Sound sound = source_->sound();
  sound.first_frame = (sound.first_frame + first_) / step_;
  return sound;
}

}  // namespace vantage
