#include "engine/message_line.h"

#include <fmt/format.h>

#include "engine/quoted_text.h"

namespace vantage {

std::string message_line(std::string_view message) {
  constexpr std::size_t kMaxBytes = 4000;
  std::string_view start = message.substr(0, kMaxBytes);
  while (start.size() < message.size() && !start.empty() &&
         (message[start.size()] & 0xC0) == 0x80) {
    start.remove_suffix(1);  // not within a character
  }
  return start.size() == message.size()
             ? printable(message)
             : fmt::format("{}... ({} bytes)", printable(start), message.size());
}

}  // namespace vantage
