#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/sequence/frame_range.h"
#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage {

/// What the journal says is finished and is there indeed.
class DeliveredFrames {
 public:
  /// Reads the journal of the layout's folder and looks for every file it tells of. Frames whose
  /// files are gone or of another size, or that are of no video segment where there are videos, do
  /// not count, but for files_of().
  explicit DeliveredFrames(const SequenceLayout& layout);

  /// Delivered and not skipped.
  [[nodiscard]] bool is_done(int frame) const;
  /// The record of a frame whose files are there, whether or not a video has it; null: there is
  /// none, or it has no files of its own.
  [[nodiscard]] const FrameRecord* files_of(int frame) const;
  /// Newest record of every frame that is done or skipped.
  [[nodiscard]] const std::map<int, FrameRecord>& records() const { return records_; }
  /// The skipped ones of `frames`, in order.
  [[nodiscard]] std::vector<int> skipped(FrameRange frames) const;
  /// Those of `frames` that are neither done nor skipped, as ranges in order.
  [[nodiscard]] std::vector<FrameRange> missing(FrameRange frames) const;
  /// Segments that are there, in order, none within another.
  [[nodiscard]] const std::vector<FrameRange>& segments() const { return segments_; }
  /// Frames of the joined videos, if they are there; else empty.
  [[nodiscard]] FrameRange joined() const { return joined_.frames; }
  /// Of those, the ones that had been skipped then.
  [[nodiscard]] const std::vector<int>& joined_skipped() const { return joined_.skipped; }
  /// Whether the videos of `frames`, whose records are all there, are joined or one segment:
  /// segments made of pieces have other bytes.
  [[nodiscard]] bool is_in_one_piece(FrameRange frames) const;
  /// Where the input ends if that is within `frames`; else their end.
  [[nodiscard]] int input_end(FrameRange frames) const;

 private:
  /// Empty when there is none.
  [[nodiscard]] FrameRange segment_with(int frame) const;

  std::map<int, FrameRecord> records_;
  std::map<int, FrameRecord> without_video_;  ///< whose files are there, but not their pictures
  std::vector<FrameRange> segments_;
  JoinRecord joined_;
};

/// "0-11, 36, 40-49": for messages.
std::string to_string(const std::vector<FrameRange>& ranges);

}  // namespace vantage
