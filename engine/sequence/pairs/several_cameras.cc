#include "engine/sequence/pairs/several_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {

SeveralCameras::SeveralCameras(std::unique_ptr<TwoCameraPairs> pairs,
                               std::vector<std::unique_ptr<FrameSource>> more)
    : pairs_(std::move(pairs)), pair_count_(pairs_->pair_count()) {
  for (std::unique_ptr<FrameSource>& source : more) {
    more_.push_back({std::move(source)});
    pair_count_ = std::min(pair_count_, frames_of(more_.back()));
    if (pair_count_ < 1) {
      throw Error(
          fmt::format("no pair has a partner in the sequence of camera {}, which has {} "
                      "frames",
                      more_.size() + 2, more_.back().source->frame_count()));
    }
  }
}

bool SeveralCameras::fetch(FramePair& pair) {
  // Where a frame of the pair is bad, the other cameras lag until the next one.
  if (!pairs_->fetch(pair) || pair.index >= pair_count_) {
    return false;
  }
  pair.more_fetched.resize(pair.wants_right ? more_.size() : 0);
  for (std::size_t k = 0; k < pair.more_fetched.size(); ++k) {
    Camera& camera = more_[k];
    FetchedFrame& frame = pair.more_fetched[k];
    const int wanted = pairs_->first_left() + pair.index;
    if (camera.next_frame != wanted) {
      camera.source->skip_to(wanted);
    }
    camera.next_frame = wanted + 1;
    if (!camera.source->fetch(frame)) {
      return false;
    }
    pair.remarks.insert(pair.remarks.end(), frame.remarks.begin(), frame.remarks.end());
    const int missing = frame.frames_missing;
    const int missing_left = pair.fetched[0].frames_missing;
    if (missing != missing_left) {
      pair.remarks.push_back(
          fmt::format("{} frames are missing in the left video but {} in that of camera {} before "
                      "pair {}: from here on the images may not be of the same moment",
                      missing_left, missing, k + 3, pair.index));
    }
  }
  return true;
}

void SeveralCameras::make_images(FramePair& pair) const {
  pairs_->decode(pair);
  pair.more.resize(pair.more_fetched.size());
  for (std::size_t k = 0; k < pair.more.size(); ++k) {
    pair.more_fetched[k].decode();
    std::swap(pair.more[k], pair.more_fetched[k].photograph);
  }
}

void SeveralCameras::skip_to(int index) { pairs_->skip_to(index); }

std::string SeveralCameras::describe(int index) const {
  std::string text = pairs_->describe(index);
  for (const Camera& camera : more_) {
    text += ", " + camera.source->describe(pairs_->first_left() + index);
  }
  return text;
}

std::vector<std::string> SeveralCameras::remarks() const {
  std::vector<std::string> remarks = pairs_->remarks();
  for (std::size_t k = 0; k < more_.size(); ++k) {
    const int frames = frames_of(more_[k]);
    const int pairs = pairs_->pair_count();
    if (frames != pairs) {
      remarks.push_back(
          fmt::format("camera {} has frames for {} pairs, but the first two cameras "
                      "have {}: the last {} {} no partner",
                      k + 3, frames, pairs, std::abs(frames - pairs),
                      std::abs(frames - pairs) == 1 ? "has" : "have"));
    }
    const FrameSpan left{pairs_->left(), pairs_->first_left(), pair_count_};
    const std::vector<std::string> numbering =
        numbering_remarks(left, {*more_[k].source, pairs_->first_left(), pair_count_});
    for (const std::string& remark : numbering) {
      if (std::ranges::find(remarks, remark) == remarks.end()) {
        remarks.push_back(remark);
      }
    }
  }
  return remarks;
}

int SeveralCameras::unpaired_frames() const {
  int max = pairs_->unpaired_frames();
  for (const Camera& camera : more_) {
    max = std::max(max, std::abs(frames_of(camera) - pairs_->pair_count()));
  }
  return max;
}

std::optional<FrameRate> SeveralCameras::frame_rate() const { return pairs_->frame_rate(); }

std::optional<FrameTimes> SeveralCameras::frame_times() const {
  const std::optional<FrameTimes> pairs = pairs_->frame_times();
  return pairs ? std::optional(pairs->some(0, pair_count_)) : std::nullopt;
}

std::vector<std::filesystem::path> SeveralCameras::files() const {
  std::vector<std::filesystem::path> files = pairs_->files();
  for (const Camera& camera : more_) {
    const std::vector<std::filesystem::path> own = camera.source->files();
    files.insert(files.end(), own.begin(), own.end());
  }
  return files;
}

std::vector<std::string> SeveralCameras::identities() const {
  std::vector<std::string> identities = pairs_->identities();
  for (const Camera& camera : more_) {
    identities.push_back(camera.source->identity());
  }
  return identities;
}

}  // namespace vantage
