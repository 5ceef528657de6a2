#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage {

/// Content of a run's journal, whether or not the files exist. Excludes records that do not name
/// the layout's files of their frames.
struct JournalContent {
  std::map<int, FrameRecord> frames;  ///< the newest record of each; done takes precedence over
                                      ///< skipped
  std::vector<SegmentRecord> segments;
  std::vector<JoinRecord> joins;
  std::vector<ReportRecord> reports;
  /// All recorded contents of each file, by name: a repeated frame is recorded again.
  std::map<std::string, std::vector<FileContent>> contents;
  int damaged_lines = 0;     ///< with a wrong checksum
  int unlikely_records = 0;  ///< naming files other than those of their frames
};

/// Reads all parts. Throws Error when a file cannot be read.
JournalContent read_journal(const SequenceLayout& layout);

}  // namespace vantage
