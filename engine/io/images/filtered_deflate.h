#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// Appends to `stream` the blocks of DEFLATE (RFC 1951) that hold `bytes`, and ends at a whole
/// byte, so that blocks made side by side are one stream when they are joined; the last ones of a
/// stream with `ends_stream`. For bytes as PNG's filters leave them, small numbers and runs of
/// zeros: each call has a Huffman code of its own, and runs of zeros are the only matches. On maps
/// as small as a search for matches makes them, in a fifth of its time; noise grows by 0.2 %, and
/// all by 160 bytes. Identical on every processor. Thread rule: pure.
void append_deflated(std::span<const std::uint8_t> bytes, bool ends_stream,
                     std::vector<std::uint8_t>& stream);

}  // namespace vantage
