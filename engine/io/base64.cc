#include "engine/io/base64.h"

#include <algorithm>

#include "engine/error.h"

extern "C" {
#include <libavutil/base64.h>
}

namespace vantage {
namespace {

// The library counts in int. Blocks of complete groups can be joined.
constexpr std::size_t kBlockGroups = std::size_t{1} << 20;
constexpr std::size_t kGroupBytes = 3;
constexpr std::size_t kGroupLetters = 4;

}  // namespace

std::string encode_base64(std::span<const std::uint8_t> bytes) {
  const std::size_t groups = (bytes.size() + kGroupBytes - 1) / kGroupBytes;
  std::string text(groups * kGroupLetters + 1, '\0');  // the library terminates each block with a
                                                       // zero
  std::size_t letters = 0;
  while (!bytes.empty()) {
    const auto block = bytes.first(std::min(bytes.size(), kBlockGroups * kGroupBytes));
    const std::size_t block_letters =
        (block.size() + kGroupBytes - 1) / kGroupBytes * kGroupLetters;
    av_base64_encode(text.data() + letters, static_cast<int>(block_letters + 1), block.data(),
                     static_cast<int>(block.size()));
    letters += block_letters;
    bytes = bytes.subspan(block.size());
  }
  text.resize(letters);
  return text;
}

std::vector<std::uint8_t> decode_base64(std::string_view text) {
  if (text.size() % kGroupLetters != 0) {
    throw Error("length of base64 text is not a multiple of 4");
  }
  std::vector<std::uint8_t> bytes(text.size() / kGroupLetters * kGroupBytes);
  std::size_t count = 0;
  while (!text.empty()) {
    const std::string block(text.substr(0, kBlockGroups * kGroupLetters));
    text.remove_prefix(block.size());
    const std::size_t room = block.size() / kGroupLetters * kGroupBytes;
    const int decoded =
        av_base64_decode(bytes.data() + count, block.c_str(), static_cast<int>(room));
    const std::size_t padding = block.ends_with("==") ? 2 : block.ends_with('=') ? 1 : 0;
    const std::size_t expected = room - padding;
    // Also detects padding before the end, because nothing after it is decoded.
    if (decoded < 0 || static_cast<std::size_t>(decoded) != expected) {
      throw Error("text is not base64 with padding");
    }
    count += expected;
  }
  bytes.resize(count);
  return bytes;
}

}  // namespace vantage
