#include "engine/io/video/video_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/checksum.h"

namespace vantage {

VideoFrames::VideoFrames(std::string file, int track, const PhotographReading& reading)
    : file_(std::move(file)),
      track_(track),
      reader_(std::make_unique<VideoReader>(file_, track)),
      film_(examine_film(file_, track)),
      frame_count_(reader_->frame_count()) {
  using Deinterlacing = PictureHandling::Deinterlacing;
  handling_.turn = reading.turns_upright ? film_.turn : Orientation::kAsStored;
  handling_.deinterlacing = !reading.deinterlaces        ? Deinterlacing::kNone
                            : film_.has_interlaced_flags ? Deinterlacing::kFlaggedFrames
                                                         : Deinterlacing::kAllFrames;
  reader_->set_handling(handling_);
}

void VideoFrames::take_fields_apart() {
  handling_.takes_fields_apart = true;
  reader_->set_handling(handling_);
}

FilmFormat VideoFrames::film_format() const {
  FilmFormat format = reader_->film_format();
  if (handling_.turn >= Orientation::kTranspose) {
    std::swap(format.pixel_aspect.width, format.pixel_aspect.height);
  }
  return format;
}

std::vector<std::string> VideoFrames::remarks() const {
  using Deinterlacing = PictureHandling::Deinterlacing;
  std::vector<std::string> remarks;
  const auto add = [&](const std::string& text) {
    remarks.push_back(fmt::format("{}: {}", file_.string(), text));
  };
  const char* first_field = film_.upper_field_first ? "upper" : "lower";
  if (handling_.deinterlacing == Deinterlacing::kAllFrames) {
    add(
        fmt::format("its pictures are not flagged as interlaced; all are deinterlaced, {} field "
                    "first",
                    first_field));
  } else if (film_.is_interlaced) {
    add(fmt::format(
        "it is interlaced, {} field first: {}", first_field,
        handling_.deinterlacing != Deinterlacing::kNone ? "its pictures are deinterlaced (bwdif)"
        : handling_.takes_fields_apart ? "the two fields of a picture are the two images"
                                       : "edges that move are combs; `deinterlace` mends them"));
  }
  if (handling_.turn != Orientation::kAsStored) {
    add("its pictures are turned as its display matrix says (`orientation` stored leaves them)");
  }
  if (film_.turns_askew) {
    add("its display matrix turns by no multiple of 90 degrees: pictures are as stored");
  }
  if (!film_.further_views.empty()) {
    add(fmt::format("it holds {}, of which only the base view is read", film_.further_views));
  }
  return remarks;
}

VideoFrames::Fetched VideoFrames::look_ahead() {
  Fetched fetched;
  try {
    fetched.is_there = fetch_next(fetched.frame);
  } catch (const Error&) {
    fetched.problem = std::current_exception();
  }
  return fetched;
}

bool VideoFrames::fetch(FetchedFrame& frame) {
  if (handling_.deinterlacing == PictureHandling::Deinterlacing::kNone) {
    return fetch_next(frame);
  }
  Fetched fetched = ahead_ ? std::move(*ahead_) : look_ahead();
  ahead_ = fetched.is_there || fetched.problem ? look_ahead() : Fetched();
  ++next_fetched_;
  const VideoPicture before = std::exchange(before_, fetched.frame.picture.share());
  if (fetched.problem) {
    std::rethrow_exception(fetched.problem);
  }
  fetched.frame.picture.set_neighbours(before, ahead_->frame.picture);
  fetched.frame.photograph = std::move(frame.photograph);
  frame = std::move(fetched.frame);
  return fetched.is_there;
}

void VideoFrames::skip_to(int index) {
  if (handling_.deinterlacing == PictureHandling::Deinterlacing::kNone) {
    skip_reader_to(index);
    return;
  }
  if (index == next_fetched_) {
    return;
  }
  before_ = {};
  ahead_.reset();
  skip_reader_to(std::max(0, index - 1));
  if (index > 0) {
    before_ = look_ahead().frame.picture.share();
  }
  next_fetched_ = index;
}

bool VideoFrames::fetch_next(FetchedFrame& frame) {
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
  frame.note_missing(reader_->frames_missing(), describe(next_index_));
  ++next_index_;
  return true;
}

void VideoFrames::skip_reader_to(int index) {
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
  return fmt::format("{} frame {}", name_of_track(file_, track_), index);
}

std::string VideoFrames::identity() const {
  FileIdentity file;
  file.add(file_.filename().string(), file_);
  return fmt::format("video {}: {}", name_of_track(file_, track_), file.to_string());
}

}  // namespace vantage
