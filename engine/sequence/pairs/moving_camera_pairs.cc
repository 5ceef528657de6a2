#include "engine/sequence/pairs/moving_camera_pairs.h"

#include <fmt/format.h>

#include <cassert>
#include <cstdlib>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {
MovingCameraPairs::MovingCameraPairs(std::unique_ptr<FrameSource> source, int step)
    : source_(std::move(source)), distance_(std::abs(step)), later_is_left_(step < 0) {
  if (pair_count() < 1) {
    throw Error(fmt::format("no frame has a partner: the sequence has {} frame{}, the step is {}",
                            source_->frame_count(), source_->frame_count() == 1 ? "" : "s", step));
  }
}

std::string MovingCameraPairs::describe(int index) const {
  const int left = later_is_left_ ? index + distance_ : index;
  const int right = later_is_left_ ? index : index + distance_;
  return fmt::format("{}, {}", source_->describe(left), source_->describe(right));
}

std::vector<std::string> MovingCameraPairs::remarks() const {
  return numbering_remarks({*source_, 0, source_->frame_count()});
}

std::optional<FrameTimes> MovingCameraPairs::frame_times() const {
  const std::optional<FrameTimes> frames = source_->frame_times();
  return frames ? std::optional(frames->some(later_is_left_ ? distance_ : 0, pair_count()))
                : std::nullopt;
}

bool MovingCameraImages::fetch(FramePair& pair) {
  if (next_index_ >= pair_count()) {
    return false;
  }
  pair.index = next_index_++;
  pair.remarks.clear();
  source().skip_to(pair.index);
  source().fetch(earlier(pair));
  source().skip_to(pair.index + distance());
  source().fetch(later(pair));
  return true;
}

MovingCameraVideo::MovingCameraVideo(std::unique_ptr<FrameSource> source, int step)
    : MovingCameraPairs(std::move(source), step),
      kept_(static_cast<std::size_t>(std::abs(step)) + 1) {}

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
  const int last = next_index_ + distance();
  while (kept_end_ <= last) {
    if (!keep_next()) {
      return false;
    }
  }
  pair.index = next_index_++;
  pair.remarks.clear();
  KeptFrame& first_frame = kept(pair.index);
  const KeptFrame& last_frame = kept(last);
  for (const KeptFrame* frame : {&std::as_const(first_frame), &last_frame}) {
    if (!frame->problem.empty()) {
      throw Error(frame->problem);
    }
  }
  int missing = 0;
  for (int frame = pair.index + 1; frame <= last; ++frame) {
    missing += kept(frame).fetched.frames_missing;
  }
  if (missing > 0) {
    pair.remarks.push_back(fmt::format("{} frame{} missing between {} and {}", missing,
                                       missing == 1 ? " is" : "s are",
                                       source().describe(pair.index), source().describe(last)));
  }
  earlier(pair).picture = std::move(first_frame.fetched.picture);
  later(pair).picture = last_frame.fetched.picture.share();
  return true;
}

void MovingCameraVideo::skip_to(int index) {
  assert(index >= 0 && index <= pair_count());
  if (index < next_index_ || index > kept_end_) {
    source().skip_to(index);
    kept_end_ = index;
  }
  next_index_ = index;
}

std::unique_ptr<PairSource> make_moving_camera_pairs(std::unique_ptr<FrameSource> source,
                                                     int step) {
  if (source->video_file().empty()) {
    return std::make_unique<MovingCameraImages>(std::move(source), step);
  }
  return std::make_unique<MovingCameraVideo>(std::move(source), step);
}

}  // namespace vantage
