#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// One machine's part of a run: number `index` (from 1) of `count`.
struct Shard {
  int index = 1;
  int count = 1;
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// Frames that a run processes.
struct FrameSelection {
  int frame_count = 0;               ///< of the whole input
  int chunk_frames = 50;             ///< chunks start at multiples of this, whatever is selected
  std::optional<FrameRange> frames;  ///< default: all; a range beyond the end is cut
  std::optional<Shard> shard;        ///< of the selected frames' chunks; default: all

  /// The selected frames of all shards together.
  [[nodiscard]] FrameRange all() const;
  /// The frames of this shard: contiguous whole chunks (except at the ends of `frames`). Shards
  /// differ by at most one chunk; with more shards than chunks some are empty.
  [[nodiscard]] FrameRange own() const;
  /// The selected part of the chunk that holds `frame`.
  [[nodiscard]] FrameRange chunk_of(int frame) const;
  /// Start of that chunk, selected or not.
  [[nodiscard]] int chunk_begin(int frame) const { return frame / chunk_frames * chunk_frames; }
};

/// Consecutive frames to process together.
struct FrameRun {
  FrameRange frames;  ///< to be delivered
  int lead_in = 0;    ///< number of frames before them, computed only for the state that they pass
                      ///< on
  friend bool operator==(const FrameRun&, const FrameRun&) = default;
};

/// Dependence between frames, which determines what must be done again.
struct FrameDependence {
  /// A frame's results depend on those before it in its chunk.
  bool on_past = false;
  /// Frames of a chunk are delivered together (video segments).
  bool whole_chunks = false;
};

/// A run of `frames`, and before them of those frames of their chunk that the first one depends on.
FrameRun run_of(const FrameSelection& selection, FrameDependence dependence, FrameRange frames);

/// Remaining work on a shard's frames, in order. Each run lies within one chunk.
std::vector<FrameRun> plan_work(const FrameSelection& selection, FrameDependence dependence,
                                const std::function<bool(int frame)>& is_done);

}  // namespace vantage
