#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace vantage {
inline namespace test {

/// The bytes of base64 text with padding, letter by letter (RFC 4648).
inline std::vector<std::uint8_t> decoded_base64(std::string_view text) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> value_of;
  value_of.fill(64);
  for (std::size_t value = 0; value < kLetters.size(); ++value) {
    value_of[static_cast<std::uint8_t>(kLetters[value])] = static_cast<std::uint8_t>(value);
  }
  if (text.size() % 4 != 0) {
    throw std::runtime_error("base64 without padding");
  }
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) {
    text.remove_suffix(1);
  }
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    const std::uint8_t value = value_of[static_cast<std::uint8_t>(letter)];
    if (value == 64) {
      throw std::runtime_error("not a letter of base64");
    }
    bits = bits << 6 | value;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return bytes;
}

}  // namespace test
}  // namespace vantage
