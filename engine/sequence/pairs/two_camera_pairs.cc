#include "engine/sequence/pairs/two_camera_pairs.h"

#include <fmt/format.h>

#include <cstdlib>
#include <numeric>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/stated_format.h"

namespace vantage {

TwoCameraPairs::TwoCameraPairs(std::unique_ptr<FrameSource> left,
                               std::unique_ptr<FrameSource> right, FramePairing pairing)
    : cameras_{std::move(left), std::move(right)}, pairing_(std::move(pairing)) {
  if (cameras_[0]->film_format() != cameras_[1]->film_format()) {
    pairing_.remarks.push_back(fmt::format(
        "the films state their pictures differently (left: {}; right: {}): the left one counts",
        to_text(cameras_[0]->film_format()), to_text(cameras_[1]->film_format())));
  }
}

bool TwoCameraPairs::fetch_of(std::size_t camera, FetchedFrame& frame,
                              std::exception_ptr& problem) {
  FrameSource& source = *cameras_[camera];
  const int wanted = pairing_.frame(camera, next_index_);
  try {
    if (std::exchange(next_frames_[camera], -1) != wanted) {
      source.skip_to(wanted);
    }
    next_frames_[camera] = wanted + 1;
    return source.fetch(frame);
  } catch (const Error&) {
    problem = problem ? problem : std::current_exception();
    return true;
  }
}

bool TwoCameraPairs::fetch(FramePair& pair) {
  if (next_index_ >= pairing_.count) {
    return false;
  }
  pair.index = next_index_;
  pair.details = details(next_index_);
  pair.remarks.clear();
  std::exception_ptr problem;
  const bool has_left = fetch_of(0, pair.fetched[0], problem);
  const bool has_right = !pair.wants_right || fetch_of(1, pair.fetched[1], problem);
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
  if (pairing_.found.by != PairBy::kOrder) {
    return true;
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
  // Who fills two streams may wait until both are read.
  for (int i = next_index_ + 1; cameras_[0]->frame_count() == kUnknownFrames && i < index; ++i) {
    for (const std::size_t camera : {0, 1}) {
      next_frames_[camera] = pairing_.frame(camera, i);
      cameras_[camera]->skip_to(next_frames_[camera]);
    }
  }
  next_index_ = index;
}

std::string TwoCameraPairs::describe(int index) const {
  return fmt::format("{}, {}", cameras_[0]->describe(pairing_.frame(0, index)),
                     cameras_[1]->describe(pairing_.frame(1, index)));
}

std::optional<FrameRate> TwoCameraPairs::frame_rate() const {
  const std::optional<FrameRate> left = cameras_[0]->frame_rate();
  const std::optional<FrameRate> right = cameras_[1]->frame_rate();
  // By time there are no more pairs a second than frames of the slower film.
  const bool right_is_slower = left && right && pairing_.found.by == PairBy::kTime &&
                               right->per_second() < left->per_second();
  return left && !right_is_slower ? left : right;
}

std::optional<FrameTimes> TwoCameraPairs::frame_times() const {
  const std::size_t camera = timing_camera();
  if (cameras_[camera]->frame_count() == kUnknownFrames) {
    return std::nullopt;
  }
  const std::optional<FrameRate> own_rate = cameras_[camera]->frame_rate();
  std::vector<int> frames;
  for (int pair = 0; pair < pairing_.count; ++pair) {
    frames.push_back(pairing_.frame(camera, pair));
  }
  std::optional<FrameTimes> times = cameras_[camera]->frame_times();
  if (!times && own_rate && frames.back() - frames.front() >= pairing_.count) {
    times = FrameTimes{std::vector<std::int64_t>(static_cast<std::size_t>(frames.back()) + 2),
                       own_rate->denominator,
                       own_rate->numerator,
                       {}};
    std::iota(times->times.begin(), times->times.end(), 0);
  }
  if (times) {
    times->rate = *frame_rate();
    times = times->of(frames);
  }
  return times;
}

PairSource::Sound TwoCameraPairs::sound() const {
  for (const std::size_t camera : {0, 1}) {
    if (const std::filesystem::path file = cameras_[camera]->video_file(); !file.empty()) {
      return {file, pairing_.frame(camera, 0) * frame_rate()->per_second() /
                        cameras_[camera]->frame_rate()->per_second()};
    }
  }
  return {};
}

std::vector<std::filesystem::path> TwoCameraPairs::files() const {
  std::vector<std::filesystem::path> files = cameras_[0]->files();
  const std::vector<std::filesystem::path> right = cameras_[1]->files();
  files.insert(files.end(), right.begin(), right.end());
  return files;
}

std::vector<std::string> TwoCameraPairs::identities() const {
  return {cameras_[0]->identity(), cameras_[1]->identity()};
}

}  // namespace vantage
