#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/error.h"
#include "engine/sequence/pairs/frame_numbering.h"
#include "engine/sequence/pairs/frame_pairing.h"

namespace vantage {
namespace {

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

std::vector<std::string> remarks_of_two(const FrameSource& left, const FrameSource& right,
                                        const FramePairing& pairing) {
  std::vector<std::string> remarks;
  for (const bool is_left : {true, false}) {
    if (const int count = pairing.found.left_out[is_left ? 0 : 1]; count > 0) {
      remarks.push_back(leftover_remark(is_left ? left : right, is_left ? "left" : "right",
                                        is_left ? "right" : "left", count));
    }
  }
  if (left.frame_rate() && right.frame_rate() && left.frame_rate() != right.frame_rate()) {
    remarks.push_back(fmt::format(
        "the left video has {} frames a second but the right one {}: pairs by index may "
        "not be of the same moment",
        to_string(*left.frame_rate()), to_string(*right.frame_rate())));
  }
  const auto numbering = numbering_remarks({left, pairing.first[0], pairing.count},
                                           {right, pairing.first[1], pairing.count});
  remarks.insert(remarks.end(), numbering.begin(), numbering.end());
  return remarks;
}

}  // namespace

FramePairing pair_in_order(const std::vector<const FrameSource*>& cameras, int offset_frames) {
  const FrameSource& left = *cameras[0];
  const FrameSource& right = *cameras[1];
  FramePairing pairing;
  pairing.first.assign(cameras.size(), std::max(0, -offset_frames));
  pairing.first[1] = std::max(0, offset_frames);
  const auto frames_of = [&](std::size_t camera) {
    return cameras[camera]->frame_count() - pairing.first[camera];
  };
  const int pairs = std::min(frames_of(0), frames_of(1));
  pairing.count = pairs;
  if (pairs < 1) {
    throw Error(
        fmt::format("no frame has a partner: the left sequence has {} frames, the right one {}, "
                    "the offset is {}",
                    left.frame_count(), right.frame_count(), offset_frames));
  }
  // The offset alone leaves as many frames at the end of one side as at the start of the other.
  pairing.found.left_out = {std::max(0, frames_of(0) - pairs - pairing.first[1]),
                            std::max(0, frames_of(1) - pairs - pairing.first[0])};
  pairing.remarks = remarks_of_two(left, right, pairing);
  for (std::size_t k = 2; k < cameras.size(); ++k) {
    const int frames = frames_of(k);
    if (frames < 1) {
      throw Error(
          fmt::format("no pair has a partner in the sequence of camera {}, which has {} frames",
                      k + 1, cameras[k]->frame_count()));
    }
    const int other = std::abs(frames - pairs);
    pairing.found.left_out.push_back(other);
    pairing.count = std::min(pairing.count, frames);
    if (other > 0) {
      pairing.remarks.push_back(fmt::format(
          "camera {} has frames for {} pairs, but the first two cameras have {}: the last {} {} no "
          "partner",
          k + 1, frames, pairs, other, other == 1 ? "has" : "have"));
    }
  }
  for (std::size_t k = 2; k < cameras.size(); ++k) {
    for (std::string& remark : numbering_remarks({left, pairing.first[0], pairing.count},
                                                 {*cameras[k], pairing.first[k], pairing.count})) {
      if (std::ranges::find(pairing.remarks, remark) == pairing.remarks.end()) {
        pairing.remarks.push_back(std::move(remark));
      }
    }
  }
  return pairing;
}

}  // namespace vantage
