#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Encodes a file or folder name for text files that must be UTF-8 (JSON, TOML): invalid bytes
/// become "\xHH". So does a backslash that would otherwise look like the start of one. All other
/// names are unchanged.
std::string stored_name(std::string_view name);

/// Inverse of stored_name().
std::string name_of_stored(std::string_view text);

}  // namespace vantage
