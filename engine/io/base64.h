#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// The bytes as base64 (RFC 4648) with padding, without line breaks. Thread rule: pure.
std::string encode_base64(std::span<const std::uint8_t> bytes);

/// Decodes the output of encode_base64(). Throws Error when `text` is not base64 with padding.
/// Thread rule: pure.
std::vector<std::uint8_t> decode_base64(std::string_view text);

}  // namespace vantage
