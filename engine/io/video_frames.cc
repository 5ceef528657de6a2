#include "engine/io/video_frames.h"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "engine/error.h"
#include "engine/io/file_identity.h"

namespace vantage {

VideoFrames::VideoFrames(std::string name)
    : name_(std::move(name)),
      reader_(std::make_unique<VideoReader>(name_)),
      frame_count_(reader_->frame_count()) {}

bool VideoFrames::fetch(FetchedFrame& frame) {
  frame.file.clear();
  frame.frames_missing = 0;
  frame.remarks.clear();
  if (!damage_.empty()) {
    if (next_index_ >= frame_count_) {
      return false;
    }
    throw Error(fmt::format("{}: lies behind damage ({})", describe(next_index_++), damage_));
  }
  try {
    if (!reader_->read(frame.photograph)) {
      return false;
    }
  } catch (const Error& error) {
    damage_ = error.what();
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
  if (index < next_index_) {
    reader_ = std::make_unique<VideoReader>(name_);
    next_index_ = 0;
    damage_.clear();
  }
  try {
    while (next_index_ < index && damage_.empty() && reader_->skip()) {
      ++next_index_;
    }
  } catch (const Error& error) {
    damage_ = error.what();
  }
  // Where the video has ended on the way, fetch() finds that out again.
  next_index_ = index;
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
