#include "engine/sequence/pairs/several_cameras.h"

#include <fmt/format.h>

#include <utility>

namespace vantage {

SeveralCameras::SeveralCameras(std::unique_ptr<TwoCameraPairs> pairs,
                               std::vector<std::unique_ptr<FrameSource>> more)
    : pairs_(std::move(pairs)) {
  for (std::unique_ptr<FrameSource>& source : more) {
    more_.push_back({std::move(source)});
  }
}

bool SeveralCameras::fetch(FramePair& pair) {
  // Where a frame of the pair is bad, the other cameras lag until the next one.
  if (!pairs_->fetch(pair)) {
    return false;
  }
  pair.more_fetched.resize(pair.wants_right ? more_.size() : 0);
  for (std::size_t k = 0; k < pair.more_fetched.size(); ++k) {
    Camera& camera = more_[k];
    FetchedFrame& frame = pair.more_fetched[k];
    const int wanted = pairs_->frames().frame(k + 2, pair.index);
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
    if (missing != missing_left && pairs_->pairing().by == PairBy::kOrder) {
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

std::string SeveralCameras::describe(int index) const {
  std::string text = pairs_->describe(index);
  for (std::size_t k = 0; k < more_.size(); ++k) {
    text += ", " + more_[k].source->describe(pairs_->frames().frame(k + 2, index));
  }
  return text;
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
