#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// Frames that are finished according to the journal and whose files exist.
class DeliveredFrames {
 public:
  /// Reads the journal of the layout's folder and checks every file that it lists. Segments whose
  /// bytes have changed do not count, nor do frames whose files are missing or of another size, or
  /// that are in no video segment if there are videos, except for files_of(). Throws Error where a
  /// segment cannot be read.
  explicit DeliveredFrames(const SequenceLayout& layout);

  /// Delivered and not skipped.
  [[nodiscard]] bool is_done(int frame) const;
  /// The record of a frame whose files exist, whether or not a video contains it; null: none, or it
  /// has no files of its own.
  [[nodiscard]] const FrameRecord* files_of(int frame) const;
  /// Newest record of every frame that is done or skipped.
  [[nodiscard]] const std::map<int, FrameRecord>& records() const { return records_; }
  /// The skipped ones of `frames`, in order.
  [[nodiscard]] std::vector<int> skipped(FrameRange frames) const;
  /// The frames of `frames` that are neither done nor skipped, as ranges in order.
  [[nodiscard]] std::vector<FrameRange> missing(FrameRange frames) const;
  /// Existing segments, in order, none within another.
  [[nodiscard]] const std::vector<FrameRange>& segments() const { return segments_; }
  /// Frames of the joined videos, if these exist; else empty.
  [[nodiscard]] FrameRange joined() const { return joined_.frames; }
  /// Frames of joined() that were skipped at the time of joining.
  [[nodiscard]] const std::vector<int>& joined_skipped() const { return joined_.skipped; }
  /// Whether the videos of `frames`, whose records all exist, are joined or one segment: segments
  /// made of pieces have other bytes.
  [[nodiscard]] bool is_in_one_piece(FrameRange frames) const;
  /// End of the input if that is within `frames`; else the end of `frames`.
  [[nodiscard]] int input_end(FrameRange frames) const;

 private:
  /// Empty when there is none.
  [[nodiscard]] FrameRange segment_with(int frame) const;

  std::map<int, FrameRecord> records_;
  std::map<int, FrameRecord> without_video_;  ///< their files exist, but not their pictures in
                                              ///< videos
  std::vector<FrameRange> segments_;
  JoinRecord joined_;
};

/// The frames of the input of a run; of a stream those up to the last one that is done or skipped.
FrameRange input_frames(const RunIdentity& identity, const DeliveredFrames& delivered);

/// "0-11, 36, 40-49": for messages.
std::string to_string(const std::vector<FrameRange>& ranges);

}  // namespace vantage
