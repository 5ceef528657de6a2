#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// ".STEM.tmp-HOST-PROCESS-NUMBER.EXT": the temporary name, in the same folder, of a file being
/// written. Unique among processes on all machines (HOST is a hash of the machine's name and of the
/// process's PID namespace). Stems are shortened to keep names within the limit of file systems
/// (255 bytes).
std::string temporary_name(const std::filesystem::path& file, int number);

/// "STEM.EXT" of such a name, shortened if the name is; empty for any other name.
std::optional<std::string> final_name_of(std::string_view temporary);

/// Removes the temporary files in `folder` left by killed processes, of files whose names `is_own`
/// accepts. No other process may be writing those. Files that cannot be removed stay.
void remove_temporary_files(const std::filesystem::path& folder,
                            const std::function<bool(const std::string& final_name)>& is_own);

/// remove_temporary_files() for one file.
void remove_temporary_files_of(const std::filesystem::path& file);

}  // namespace vantage
