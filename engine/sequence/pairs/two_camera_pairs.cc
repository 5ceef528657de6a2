#include "engine/sequence/pairs/two_camera_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <exception>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/stated_format.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {
namespace {

/// Fetches even if the other camera's frame was bad, so that both stay in step; keeps the first
/// problem.
bool fetch_from(FrameSource& source, FetchedFrame& frame, std::exception_ptr& problem) {
  try {
    return source.fetch(frame);
  } catch (const Error&) {
    problem = problem ? problem : std::current_exception();
    return true;
  }
}

std::string leftover_remark(const FrameSource& source, const char* side, const char* other_side,
                            int count) {
  const int frames = source.frame_count();
  const std::string which = count == 1
                                ? source.describe(frames - 1) + " has"
                                : fmt::format("{} to {} have", source.describe(frames - count),
                                              source.describe(frames - 1));
  return fmt::format("the {} sequence has {} frame{} more than the {} one: {} no partner", side,
                     count, count == 1 ? "" : "s", other_side, which);
}

}  // namespace

TwoCameraPairs::TwoCameraPairs(std::unique_ptr<FrameSource> left,
                               std::unique_ptr<FrameSource> right, int offset_frames,
                               bool numbers_matter)
    : left_(std::move(left)),
      right_(std::move(right)),
      numbers_matter_(numbers_matter),
      first_left_(std::max(0, -offset_frames)),
      first_right_(std::max(0, offset_frames)),
      pair_count_(
          std::min(left_->frame_count() - first_left_, right_->frame_count() - first_right_)) {
  if (pair_count_ < 1) {
    throw Error(
        fmt::format("no frame has a partner: the left sequence has {} frames, the right one {}, "
                    "the offset is {}",
                    left_->frame_count(), right_->frame_count(), offset_frames));
  }
  skip_to(0);
}

bool TwoCameraPairs::fetch_right(FetchedFrame& frame, std::exception_ptr& problem) {
  if (std::exchange(right_lags_, false)) {
    right_->skip_to(first_right_ + next_index_);
  }
  return fetch_from(*right_, frame, problem);
}

bool TwoCameraPairs::fetch(FramePair& pair) {
  if (next_index_ >= pair_count_) {
    return false;
  }
  pair.index = next_index_;
  pair.details = details(next_index_);
  pair.remarks.clear();
  std::exception_ptr problem;
  const bool has_left = fetch_from(*left_, pair.fetched[0], problem);
  const bool has_right = !pair.wants_right || fetch_right(pair.fetched[1], problem);
  right_lags_ = right_lags_ || !pair.wants_right;
  if (!has_left || !has_right) {
    return false;
  }
  ++next_index_;
  if (problem) {
    std::rethrow_exception(problem);
  }
  if (!pair.wants_right) {
    pair.remarks = pair.fetched[0].remarks;
    return true;
  }
  for (const FetchedFrame& frame : pair.fetched) {
    pair.remarks.insert(pair.remarks.end(), frame.remarks.begin(), frame.remarks.end());
  }
  const int missing_left = pair.fetched[0].frames_missing;
  const int missing_right = pair.fetched[1].frames_missing;
  if (missing_left != missing_right) {
    const int more = std::abs(missing_left - missing_right);
    const bool is_left = missing_left > missing_right;
    pair.remarks.push_back(
        fmt::format("{} more frame{} missing in the {} video than in the {} one before pair {}: "
                    "from here on the pairs may not be of the same moment",
                    more, more == 1 ? " is" : "s are", is_left ? "left" : "right",
                    is_left ? "right" : "left", pair.index));
  }
  return true;
}

void TwoCameraPairs::skip_to(int index) {
  assert(index >= 0 && index <= pair_count_);
  // Who fills two streams may wait until both are read.
  for (int i = next_index_ + 1; left_->frame_count() == kUnknownFrames && i < index; ++i) {
    left_->skip_to(first_left_ + i);
    right_->skip_to(first_right_ + i);
  }
  left_->skip_to(first_left_ + index);
  right_->skip_to(first_right_ + index);
  next_index_ = index;
  right_lags_ = false;
}

std::string TwoCameraPairs::describe(int index) const {
  return fmt::format("{}, {}", left_->describe(first_left_ + index),
                     right_->describe(first_right_ + index));
}

std::vector<std::string> TwoCameraPairs::remarks() const {
  std::vector<std::string> remarks;
  if (unpaired_frames() > 0) {
    remarks.push_back(left_over() > 0
                          ? leftover_remark(*left_, "left", "right", unpaired_frames())
                          : leftover_remark(*right_, "right", "left", unpaired_frames()));
  }
  const std::optional<FrameRate> left_rate = left_->frame_rate();
  const std::optional<FrameRate> right_rate = right_->frame_rate();
  if (left_rate && right_rate &&
      left_rate->numerator * right_rate->denominator !=
          right_rate->numerator * left_rate->denominator) {
    remarks.push_back(fmt::format(
        "the left video has {} frames a second but the right one {}: pairs by index may "
        "not be of the same moment",
        to_string(*left_rate), to_string(*right_rate)));
  }
  if (left_->film_format() != right_->film_format()) {
    const auto text = [](const FrameSource& side) {
      const std::string stated = to_text(side.film_format());
      return stated.empty() ? "no such" : stated;
    };
    remarks.push_back(
        fmt::format("the left film states {}, the right one {}: what is written is "
                    "stated as the left one",
                    text(*left_), text(*right_)));
  }
  if (numbers_matter_) {
    const std::vector<std::string> numbering =
        numbering_remarks({*left_, first_left_, pair_count_}, {*right_, first_right_, pair_count_});
    remarks.insert(remarks.end(), numbering.begin(), numbering.end());
  }
  return remarks;
}

int TwoCameraPairs::unpaired_frames() const {
  // The offset alone leaves as many frames at the end of one side as at the start of the other.
  return std::max({0, left_over() - first_right_, right_over() - first_left_});
}

std::optional<FrameRate> TwoCameraPairs::frame_rate() const {
  const std::optional<FrameRate> left_rate = left_->frame_rate();
  return left_rate ? left_rate : right_->frame_rate();
}

std::optional<FrameTimes> TwoCameraPairs::frame_times() const {
  const bool takes_left = left_->frame_rate().has_value();
  const std::optional<FrameTimes> frames =
      takes_left ? left_->frame_times() : right_->frame_times();
  return frames ? std::optional(frames->some(takes_left ? first_left_ : first_right_, pair_count_))
                : std::nullopt;
}

PairSource::Sound TwoCameraPairs::sound() const {
  if (const std::filesystem::path file = left_->video_file(); !file.empty()) {
    return {file, static_cast<double>(first_left_)};
  }
  return {right_->video_file(), static_cast<double>(first_right_)};
}

std::vector<std::filesystem::path> TwoCameraPairs::files() const {
  std::vector<std::filesystem::path> files = left_->files();
  const std::vector<std::filesystem::path> right = right_->files();
  files.insert(files.end(), right.begin(), right.end());
  return files;
}

std::vector<std::string> TwoCameraPairs::identities() const {
  return {left_->identity(), right_->identity()};
}

}  // namespace vantage
