#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vantage {

/// `text` as one line that cannot control a terminal: control characters and invalid UTF-8 become
/// \n, \t, \x1B and so on. Other text is unchanged.
std::string printable(std::string_view text);

/// A foreign value as quoted in messages: printable; long values are shortened to their start and
/// their length.
std::string quotable(std::string_view text);

/// Bytes of the UTF-8 character at the start of `text`, which is not empty; 0: invalid.
std::size_t utf8_bytes(std::string_view text);

}  // namespace vantage
