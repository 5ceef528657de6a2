#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/video/frame_source.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Which frames of several cameras are of one moment.
struct FramePairing {
  Pairing found = {};
  int count = 0;  ///< of pairs, at least 1
  /// Of each camera: its frame in each pair, in the order of the left camera. Empty: frame
  /// `first` + i in pair i.
  std::vector<std::vector<int>> frames = {};
  std::vector<int> first = {};
  std::vector<std::string> remarks = {};  ///< see PairSource::remarks()

  [[nodiscard]] int frame(std::size_t camera, int pair) const {
    return frames.empty() ? first[camera] + pair : frames[camera][static_cast<std::size_t>(pair)];
  }
};

/// Frame i + offset_frames of the right camera, and frame i of any other, with frame i of the left
/// one. Throws Error when no frame has a partner.
FramePairing pair_in_order(const std::vector<const FrameSource*>& cameras, int offset_frames);

/// Pairs the frames of two or more cameras, each with the left one, which is the first.
///
/// Names: image files whose names share something (NameReading; the first reading that finds a
/// pair), time stamps within half a frame. Time: of films, when frames are shown, within half a
/// frame; of images, time stamps alone. A frame without a partner is left out. Empty `by`: names of
/// images, the times of films, and order where these tell nothing and no frame can be missing.
///
/// `offset_frames` counts from the first frames of both: those of frame i and i + offset_frames,
/// which belong together, tell how far the numbers or times of the two cameras are apart.
///
/// Throws Error when no frame has a partner, and where names share nothing but frames are missing;
/// UsageError for films by name.
FramePairing pair_frames(const std::vector<const FrameSource*>& cameras, int offset_frames,
                         std::optional<PairBy> by);

}  // namespace vantage
