#include "engine/io/files/encoded_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr char kBase64Letters[] =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::size_t kEscapeLength = 4;  // \xHH

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

std::string encode_base64(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kGroupBytes = 3;
  constexpr std::size_t kGroupLetters = 4;
  std::string text((bytes.size() + kGroupBytes - 1) / kGroupBytes * kGroupLetters, '=');
  std::size_t letters = 0;
  for (std::size_t first = 0; first < bytes.size(); first += kGroupBytes) {
    const std::size_t count = std::min(kGroupBytes, bytes.size() - first);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < kGroupBytes; ++i) {
      group = group << 8 | (i < count ? bytes[first + i] : 0U);
    }
    for (std::size_t i = 0; i <= count; ++i) {
      text[letters + i] = kBase64Letters[group >> (18 - 6 * i) & 63];
    }
    letters += kGroupLetters;
  }
  return text;
}

std::string escaped_markup(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string stored_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t length = escaped_byte(name) >= 0 ? 0 : utf8_bytes(name);
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
