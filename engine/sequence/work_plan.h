#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/sequence/frame_range.h"

namespace vantage {

/// One machine's part of a run: number `index` (from 1) of `count`.
struct Shard {
  int index = 1;
  int count = 1;
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// Which frames a run is to make.
struct FrameSelection {
  int frame_count = 0;               ///< of the whole input
  int chunk_frames = 50;             ///< chunks begin at multiples of this, whatever is selected
  std::optional<FrameRange> frames;  ///< default: all; a range that reaches past the end is cut
  std::optional<Shard> shard;        ///< of the selected frames' chunks; default: all

  /// The selected frames of all shards together.
  [[nodiscard]] FrameRange all() const;
  /// The frames of this shard: whole chunks (but for the ends of `frames`), in one piece. Shards
  /// differ by at most one chunk; with more shards than chunks some have none.
  [[nodiscard]] FrameRange own() const;
  /// The selected part of the chunk that holds `frame`.
  [[nodiscard]] FrameRange chunk_of(int frame) const;
  /// Where that chunk begins, selected or not.
  [[nodiscard]] int chunk_begin(int frame) const { return frame / chunk_frames * chunk_frames; }
};

/// Consecutive frames to work on in one go.
struct FrameRun {
  FrameRange frames;  ///< to be delivered
  int lead_in = 0;    ///< so many frames before them are computed only for what they hand on
  friend bool operator==(const FrameRun&, const FrameRun&) = default;
};

/// How frames depend on each other, which decides what must be done again.
struct FrameDependence {
  /// Frames before it, within its chunk, that a frame's results depend on: none, one, or all.
  enum class Past { kNone, kOne, kChunk };
  Past past = Past::kNone;
  /// Frames of a chunk are delivered together (video segments).
  bool whole_chunks = false;
};

/// What is left to do of a shard's frames, in order. Each run lies within one chunk.
std::vector<FrameRun> plan_work(const FrameSelection& selection, FrameDependence dependence,
                                const std::function<bool(int frame)>& is_done);

}  // namespace vantage
