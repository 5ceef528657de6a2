#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/sequence/options/sequence_layout.h"

namespace vantage {

/// A result that has changed since it was written.
struct DamagedFile {
  std::string name;     ///< relative to the run's folder
  std::string problem;  ///< "is missing", "has 12 bytes, expected 34", "has other content"
};

struct RunVerification {
  int files = 0;            ///< number read
  std::uint64_t bytes = 0;  ///< their size
  std::vector<DamagedFile> damaged;
  /// Journal lines with a wrong checksum: their frames are computed and recorded again.
  int damaged_lines = 0;
  bool interrupted = false;
};

/// Reads all results listed in the journal and compares them with their checksums. Segments of
/// joined videos may be missing. Throws Error when the journal cannot be read.
RunVerification verify_run(const SequenceLayout& layout,
                           const std::function<void(int files_done, int files_total)>& on_progress,
                           const std::atomic<bool>* stop);

}  // namespace vantage
