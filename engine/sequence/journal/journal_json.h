#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/sequence/journal/run_journal.h"

namespace vantage {

/// A record as one line of JSON with its checksum and line end, in UTF-8 for any file names.
std::string line_of(const JournalRecord& record);
/// Empty when the line is not a record, or was changed.
std::optional<JournalRecord> record_of(const std::string& line);

/// Content of run.json.
std::string text_of(const RunIdentity& identity);
/// Throws Error naming `file`, which holds `text`, when that is damaged or of another format.
RunIdentity identity_of(const std::string& text, const std::filesystem::path& file);

/// Differences of `now` from `then`, for messages; empty if there are none.
std::string difference(const RunIdentity& then, const RunIdentity& now);

}  // namespace vantage
