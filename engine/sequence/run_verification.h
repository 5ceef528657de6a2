#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/sequence/sequence_layout.h"

namespace vantage {

/// A result that is not as it was written.
struct DamagedFile {
  std::string name;     ///< relative to the run's folder
  std::string problem;  ///< "is missing", "has 12 bytes, expected 34", "has other content"
};

struct RunVerification {
  int files = 0;            ///< that were read
  std::uint64_t bytes = 0;  ///< of these
  std::vector<DamagedFile> damaged;
  /// Lines of the journal that cannot be believed: their frames are made anew, and then recorded
  /// anew.
  int damaged_lines = 0;
  bool interrupted = false;
};

/// Reads all results that the journal tells of and compares them with the checksums that they had
/// when they were written. Segments of videos that have been joined may be gone. Throws Error when
/// the journal cannot be read.
RunVerification verify_run(const SequenceLayout& layout,
                           const std::function<void(int files_done, int files_total)>& on_progress,
                           const std::atomic<bool>* stop);

}  // namespace vantage
