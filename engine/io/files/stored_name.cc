#include "engine/io/files/stored_name.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace vantage {
namespace {

constexpr std::size_t kEscapeLength = 4;  // \xHH

/// Bytes of the UTF-8 character at the start of `text`; 0: invalid.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) {
    return 1;
  }
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) {
    return 0;
  }
  std::uint32_t code = lead & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) {
      return 0;
    }
    code = code << 6U | (byte(i) & 0x3fU);
  }
  const bool is_overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  return is_overlong || is_surrogate || code > 0x10ffff ? 0 : length;
}

int digit_value(char letter) {
  return letter >= '0' && letter <= '9'   ? letter - '0'
         : letter >= 'a' && letter <= 'f' ? letter - 'a' + 10
                                          : -1;
}

/// The byte encoded by an escape at the start of `text`; -1: none.
int escaped_byte(std::string_view text) {
  if (text.size() < kEscapeLength || !text.starts_with("\\x")) {
    return -1;
  }
  const int high = digit_value(text[2]);
  const int low = digit_value(text[3]);
  return high < 0 || low < 0 ? -1 : high * 16 + low;
}

}  // namespace

std::string stored_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t length = escaped_byte(name) >= 0 ? 0 : character_length(name);
    if (length == 0) {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(name[0]));
      name.remove_prefix(1);
    } else {
      text += name.substr(0, length);
      name.remove_prefix(length);
    }
  }
  return text;
}

std::string name_of_stored(std::string_view text) {
  std::string name;
  while (!text.empty()) {
    const int byte = escaped_byte(text);
    name += byte >= 0 ? static_cast<char>(byte) : text[0];
    text.remove_prefix(byte >= 0 ? kEscapeLength : 1);
  }
  return name;
}

}  // namespace vantage
