#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// A message as one line of at most about 4,000 bytes, printable(): names and values of files may
/// be of any length.
std::string message_line(std::string_view message);

}  // namespace vantage
