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
  /// files are gone, or that are of no video segment where there are videos, do not count.
  explicit DeliveredFrames(const SequenceLayout& layout);

  /// Delivered and not skipped.
  [[nodiscard]] bool is_done(int frame) const;
  /// Newest record of every frame that is done or skipped.
  [[nodiscard]] const std::map<int, FrameRecord>& records() const { return records_; }
  /// Those of `frames` that are neither done nor skipped, as ranges in order.
  [[nodiscard]] std::vector<FrameRange> missing(FrameRange frames) const;
  /// Segments that are there, in order, none within another.
  [[nodiscard]] const std::vector<FrameRange>& segments() const { return segments_; }
  /// Frames of the joined videos, if they are there; else empty.
  [[nodiscard]] FrameRange joined() const { return joined_; }

 private:
  std::map<int, FrameRecord> records_;
  std::vector<FrameRange> segments_;
  FrameRange joined_;
};

/// "0-11, 36, 40-49": for messages.
std::string to_string(const std::vector<FrameRange>& ranges);

}  // namespace vantage
