#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// The bytes as base64 (RFC 4648) with padding, without line breaks. Thread rule: pure.
std::string encode_base64(std::span<const std::uint8_t> bytes);

/// `text` escaped for the content or a quoted attribute value of an XML or HTML element.
std::string escaped_markup(std::string_view text);

/// Encodes a file or folder name for text files that must be UTF-8 (JSON, TOML): invalid bytes
/// become "\xHH". So does a backslash that would otherwise look like the start of one. All other
/// names are unchanged.
std::string stored_name(std::string_view name);

/// Inverse of stored_name().
std::string name_of_stored(std::string_view text);

}  // namespace vantage
