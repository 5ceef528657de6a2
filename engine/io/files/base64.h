#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vantage {

/// The bytes as base64 (RFC 4648) with padding, without line breaks. Thread rule: pure.
std::string encode_base64(std::span<const std::uint8_t> bytes);

}  // namespace vantage
