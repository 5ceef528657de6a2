#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// `text` as one line that cannot steer a terminal: control characters and bytes that are not UTF-8
/// become \n, \t, \x1B and the like. Text that has none of them stays as it is.
std::string printable(std::string_view text);

/// What a message shows of a value that somebody else wrote: printable, and of a long one only the
/// beginning and its length.
std::string quotable(std::string_view text);

}  // namespace vantage
