#include "engine/io/video/video_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/checksum.h"

namespace vantage {

VideoFrames::VideoFrames(std::string name)
    : name_(std::move(name)),
      reader_(std::make_unique<VideoReader>(name_)),
      frame_count_(reader_->frame_count()) {}

bool VideoFrames::fetch(FetchedFrame& frame) {
  frame.file.clear();
  frame.picture = {};
  frame.frames_missing = 0;
  frame.remarks.clear();
  if (next_index_ < next_good_) {
    throw Error(fmt::format("{}: follows damage ({})", describe(next_index_++), damage_));
  }
  try {
    if (!reader_->read(frame.picture)) {
      return false;
    }
  } catch (const Error& error) {
    note_damage(error.what());
    ++next_index_;
    throw;
  }
  frame.frames_missing = reader_->frames_missing();
  if (frame.frames_missing > 0) {
    frame.remarks.push_back(fmt::format("{} frame{} missing before {}", frame.frames_missing,
                                        frame.frames_missing == 1 ? " is" : "s are",
                                        describe(next_index_)));
  }
  ++next_index_;
  return true;
}

void VideoFrames::skip_to(int index) {
  assert(index >= 0 && index <= frame_count_);
  // One frame before `index`, so that a gap between the two is noticed.
  const int last_start = std::max(0, index - 1);
  const std::optional<int> start = index < next_index_
                                       ? reader_->go_to_start(0, last_start)
                                       : reader_->go_to_start(next_index_ + 1, last_start);
  if (start) {
    next_index_ = *start;
    next_good_ = 0;
  }
  while (next_index_ < index) {
    if (next_index_ < next_good_) {
      next_index_ = std::min(next_good_, index);
      continue;
    }
    try {
      if (!reader_->skip()) {
        break;
      }
    } catch (const Error& error) {
      note_damage(error.what());
    }
    ++next_index_;
  }
  // If the video ended on the way, fetch() detects that again.
  next_index_ = index;
}

void VideoFrames::note_damage(const std::string& problem) {
  damage_ = problem;
  next_good_ = reader_->go_to_next_start(next_index_ + 1).value_or(frame_count_);
}

std::string VideoFrames::describe(int index) const {
  return fmt::format("{} frame {}", name_, index);
}

std::string VideoFrames::identity() const {
  FileIdentity file;
  file.add(std::filesystem::path(name_).filename().string(), name_);
  return fmt::format("video {}: {}", name_, file.to_string());
}

}  // namespace vantage
