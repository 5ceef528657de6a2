#pragma once

#include <filesystem>

namespace vantage {

// The temporary files of this process, known to handlers of signals that end it. Thread rule: all
// functions may be called concurrently.

/// Call note_unfinished() before the file is created, and forget_unfinished() once for each call
/// after the file has been renamed or removed.
void note_unfinished(const std::filesystem::path& file);
void forget_unfinished(const std::filesystem::path& file);

/// Removes all of them. For a handler of SIGINT, SIGTERM and SIGHUP that blocks all three and then
/// ends the process: no file can be noted any more. Async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace vantage
