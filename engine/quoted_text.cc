#include "engine/quoted_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t kMaxQuotedBytes = 100;

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// Size in bytes of the visible character at the start of `text`; 0 for a control character or
/// invalid UTF-8.
std::size_t visible_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t count = utf8_bytes(text);
  const bool is_control =
      first < 0x20 || first == 0x7F ||
      (first == 0xC2 && count == 2 && static_cast<unsigned char>(text[1]) < 0xA0);
  return is_control ? 0 : count;
}

std::string escaped(char byte) {
  switch (byte) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return fmt::format("\\x{:02X}", static_cast<unsigned char>(byte));
  }
}

}  // namespace

std::size_t utf8_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) {
    return 1;
  }
  const std::size_t count = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < count ||
      !std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(count),
                   is_continuation)) {
    return 0;
  }
  const auto second = static_cast<unsigned char>(text[1]);
  const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool is_no_character =
      (first == 0xED && second >= 0xA0) || (first == 0xF4 && second > 0x8F);
  return is_overlong || is_no_character ? 0 : count;
}

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t visible = visible_bytes(text);
    if (visible > 0) {
      result += text.substr(0, visible);
    } else {
      result += escaped(text[0]);
    }
    text.remove_prefix(std::max<std::size_t>(visible, 1));
  }
  return result;
}

std::string quotable(std::string_view text) {
  if (text.size() <= kMaxQuotedBytes) {
    return printable(text);
  }
  std::size_t end = kMaxQuotedBytes;
  while (end > kMaxQuotedBytes - 4 && is_continuation(text[end])) {
    --end;  // not in the middle of a character
  }
  return fmt::format("{}... ({} bytes)", printable(text.substr(0, end)), text.size());
}

}  // namespace vantage
