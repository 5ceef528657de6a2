#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// ".STEM.tmp-HOST-PROCESS-NUMBER.EXT": what a file of this name is called while it is written, in
/// the same folder. No other process has the name, on whatever machine it runs (HOST is a hash of
/// the machine's name and of the process's space of numbers). Names that would be longer than file
/// systems allow (255 bytes) have a shortened stem.
std::string temporary_name(const std::filesystem::path& file, int number);

/// "STEM.EXT" of such a name, shortened where that is; empty for any other name.
std::optional<std::string> final_name_of(std::string_view temporary);

/// Removes the temporary files in `folder` that killed processes have left of files whose names
/// `is_own` accepts. Nothing else may be writing those. What cannot be removed stays.
void remove_temporary_files(const std::filesystem::path& folder,
                            const std::function<bool(const std::string& final_name)>& is_own);

/// The same of one file.
void remove_temporary_files_of(const std::filesystem::path& file);

}  // namespace vantage
