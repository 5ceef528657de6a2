#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace vantage {

/// A file directly in `folder`, which need not exist, whose name `is_made` accepts; empty if there
/// is none.
std::filesystem::path existing_file(const std::filesystem::path& folder,
                                    const std::function<bool(const std::string& name)>& is_made);

/// Throws Error: `file` is not to be replaced unless the caller asks for that.
[[noreturn]] void refuse_to_replace(const std::filesystem::path& file);

/// refuse_to_replace() the existing_file(), if there is one.
void require_no_existing_file(const std::filesystem::path& folder,
                              const std::function<bool(const std::string& name)>& is_made);

}  // namespace vantage
