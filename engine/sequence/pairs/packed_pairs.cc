#include "engine/sequence/pairs/packed_pairs.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {

PackedPairs::PackedPairs(std::unique_ptr<FrameSource> source, StereoPacking packing)
    : source_(std::move(source)), packing_(packing) {}

bool PackedPairs::fetch(FramePair& pair) {
  if (next_index_ >= pair_count()) {
    return false;
  }
  FetchedFrame& frame = pair.fetched[0];
  pair.index = next_index_++;
  pair.remarks.clear();
  if (!source_->fetch(frame)) {
    return false;
  }
  pair.remarks = frame.remarks;
  return true;
}

void PackedPairs::make_images(FramePair& pair) const {
  FetchedFrame& frame = pair.fetched[0];
  if (packing_ == StereoPacking{.right_first = packing_.right_first} && !frame.picture.is_empty()) {
    PictureHalves halves = {&pair.left, pair.wants_right ? &pair.right : nullptr};
    if (packing_.right_first) {
      std::swap(halves[0], halves[1]);
    }
    if (frame.picture.convert(frame.photograph, halves)) {
      return;
    }
  } else {
    frame.decode();
  }
  try {
    if (pair.wants_right) {
      unpack_stereo(frame.photograph, packing_, pair.left, pair.right);
    } else {
      unpack_left(frame.photograph, packing_, pair.left);
    }
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", describe(pair.index), error.what()));
  }
}

void PackedPairs::skip_to(int index) {
  source_->skip_to(index);
  next_index_ = index;
}

std::vector<std::string> PackedPairs::remarks() const {
  return numbering_remarks({*source_, 0, source_->frame_count()});
}

}  // namespace vantage
