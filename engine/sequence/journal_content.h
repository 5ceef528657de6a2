#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage {

/// What the journal of a run says, whether or not the files are there. A record that does not name
/// the files which the layout has for its frames is not among it.
struct JournalContent {
  std::map<int, FrameRecord> frames;  ///< the newest record of each; done goes before skipped
  std::vector<SegmentRecord> segments;
  std::vector<JoinRecord> joins;
  /// What each file has been, by its name: a frame that is made anew is recorded again.
  std::map<std::string, std::vector<FileContent>> contents;
  int damaged_lines = 0;     ///< whose checksum is wrong
  int unlikely_records = 0;  ///< that name other files than their frames have
};

/// Reads all parts. Throws Error when a file cannot be read.
JournalContent read_journal(const SequenceLayout& layout);

}  // namespace vantage
