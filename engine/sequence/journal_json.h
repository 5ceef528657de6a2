#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/sequence/run_journal.h"

namespace vantage {

/// A record as one line of JSON with its checksum and line end, in UTF-8 whatever file names hold.
std::string line_of(const JournalRecord& record);
/// Empty when the line is none of ours, or not as it was written.
std::optional<JournalRecord> record_of(const std::string& line);

/// What run.json holds.
std::string text_of(const RunIdentity& identity);
/// Throws Error naming `file`, which holds `text`, when that is damaged or of another format.
RunIdentity identity_of(const std::string& text, const std::filesystem::path& file);

/// What of `now` is not as in `then`, for messages; empty when nothing is.
std::string difference(const RunIdentity& then, const RunIdentity& now);

}  // namespace vantage
