#include "engine/io/files/base64.h"

#include <algorithm>

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

}  // namespace vantage
