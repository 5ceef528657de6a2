#include "engine/sequence/pairs/moving_camera_pairs.h"

#include <fmt/format.h>

#include <cassert>
#include <cstdlib>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {
MovingCameraPairs::MovingCameraPairs(std::unique_ptr<FrameSource> source, SuccessiveFrames pairs)
    : source_(std::move(source)),
      distance_(std::abs(pairs.step)),
      between_pairs_(pairs.distance),
      later_is_left_(pairs.step < 0) {
  if (source_->frame_count() <= distance_) {
    throw Error(fmt::format("no frame has a partner: the sequence has {} frame{}, the step is {}",
                            source_->frame_count(), source_->frame_count() == 1 ? "" : "s",
                            pairs.step));
  }
}

std::string MovingCameraPairs::describe(int index) const {
  const int left = later_is_left_ ? later_frame(index) : earlier_frame(index);
  const int right = later_is_left_ ? earlier_frame(index) : later_frame(index);
  return fmt::format("{}, {}", source_->describe(left), source_->describe(right));
}

std::vector<std::string> MovingCameraPairs::remarks() const {
  std::vector<std::string> remarks = numbering_remarks({*source_, 0, source_->frame_count()});
  if (takes_turns() && source_->frame_count() % 2 != 0) {
    remarks.push_back(fmt::format("{} has no partner: two successive pictures are a pair",
                                  source_->describe(source_->frame_count() - 1)));
  }
  return remarks;
}

std::optional<FrameRate> MovingCameraPairs::frame_rate() const {
  const std::optional<FrameRate> rate = source_->frame_rate();
  return rate ? std::optional(slowed_down(*rate, between_pairs_)) : std::nullopt;
}

std::optional<FrameTimes> MovingCameraPairs::frame_times() const {
  const std::optional<FrameTimes> frames = source_->frame_times();
  return frames ? std::optional(frames->some(first_left(), pair_count(), between_pairs_))
                : std::nullopt;
}

bool MovingCameraImages::fetch(FramePair& pair) {
  if (next_index_ >= pair_count()) {
    return false;
  }
  pair.index = next_index_++;
  pair.remarks.clear();
  source().skip_to(earlier_frame(pair.index));
  source().fetch(earlier(pair));
  source().skip_to(later_frame(pair.index));
  source().fetch(later(pair));
  return true;
}

MovingCameraVideo::MovingCameraVideo(std::unique_ptr<FrameSource> source, SuccessiveFrames pairs)
    : MovingCameraPairs(std::move(source), pairs),
      kept_(static_cast<std::size_t>(distance()) + 1) {}

bool MovingCameraVideo::keep_next() {
  KeptFrame& place = kept(kept_end_);
  place.problem.clear();
  try {
    if (!source().fetch(place.fetched)) {
      return false;
    }
  } catch (const Error& error) {
    place.problem = error.what();
    place.fetched.frames_missing = 0;
  }
  ++kept_end_;
  return true;
}

bool MovingCameraVideo::fetch(FramePair& pair) {
  if (next_index_ >= pair_count()) {
    return false;
  }
  const int first = earlier_frame(next_index_);
  const int last = later_frame(next_index_);
  while (kept_end_ <= last) {
    if (!keep_next()) {
      return false;
    }
  }
  pair.index = next_index_++;
  pair.remarks.clear();
  KeptFrame& first_frame = kept(first);
  const KeptFrame& last_frame = kept(last);
  for (const KeptFrame* frame : {&std::as_const(first_frame), &last_frame}) {
    if (!frame->problem.empty()) {
      throw Error(frame->problem);
    }
  }
  int missing = 0;
  for (int frame = first + 1; frame <= last; ++frame) {
    missing += kept(frame).fetched.frames_missing;
  }
  if (missing > 0) {
    pair.remarks.push_back(fmt::format("{} frame{} missing between {} and {}", missing,
                                       missing == 1 ? " is" : "s are", source().describe(first),
                                       source().describe(last)));
  }
  if (const int before = missing + first_frame.fetched.frames_missing;
      takes_turns() && before % 2 != 0) {
    pair.remarks.push_back(
        fmt::format("{} picture{} missing before {}: from here on left and right may be exchanged",
                    before, before == 1 ? " is" : "s are", source().describe(last)));
  }
  earlier(pair).picture = std::move(first_frame.fetched.picture);
  later(pair).picture = last_frame.fetched.picture.share();
  return true;
}

void MovingCameraVideo::skip_to(int index) {
  assert(index >= 0 && index <= pair_count());
  if (const int first = earlier_frame(index);
      first < earlier_frame(next_index_) || first > kept_end_) {
    source().skip_to(first);
    kept_end_ = first;
  }
  next_index_ = index;
}

std::unique_ptr<PairSource> make_moving_camera_pairs(std::unique_ptr<FrameSource> source,
                                                     SuccessiveFrames pairs) {
  if (source->video_file().empty() && source->frame_count() != kUnknownFrames) {
    return std::make_unique<MovingCameraImages>(std::move(source), pairs);
  }
  return std::make_unique<MovingCameraVideo>(std::move(source), pairs);
}

}  // namespace vantage
