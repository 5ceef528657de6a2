#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// The name of a file or folder as text files hold it that must be UTF-8 (JSON, TOML): bytes that
/// are none become "\xHH". So does a backslash that would otherwise be read as the begin of that.
/// All other names stay as they are.
std::string stored_name(std::string_view name);

/// The bytes that stored_name() was given.
std::string name_of_stored(std::string_view text);

}  // namespace vantage
