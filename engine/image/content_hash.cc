#include "engine/image/content_hash.h"

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace vantage {
namespace {

/// Finaliser of the SplitMix64 generator: every result bit depends on every input bit.
std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

/// Four independent chains, so that their multiplications overlap.
class Hash {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* source = static_cast<const unsigned char*>(data);
    constexpr std::size_t kBlock = sizeof chains_;
    for (; bytes >= kBlock; bytes -= kBlock, source += kBlock) {
      std::uint64_t words[4];
      std::memcpy(words, source, kBlock);
      for (std::size_t i = 0; i < 4; ++i) {
        chains_[i] = (chains_[i] ^ words[i]) * 0x9e3779b97f4a7c15U;
        chains_[i] ^= chains_[i] >> 29U;
      }
    }
    std::uint64_t rest[4] = {bytes, 0, 0, 0};
    for (std::size_t i = 0; i < bytes; ++i) {
      rest[1 + i / 16] = (rest[1 + i / 16] + source[i]) * 0x100000001b3U;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      chains_[i] = mixed(chains_[i] ^ rest[i]);
    }
  }
  [[nodiscard]] std::uint64_t value() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t chain : chains_) {
      sum = mixed(sum + chain);
    }
    return sum;
  }

 private:
  std::uint64_t chains_[4] = {1, 2, 3, 4};
};

}  // namespace

bool have_same_pixels(const Photograph& a, const Photograph& b) {
  if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels()) {
    return false;
  }
  return std::visit(
      [&](const auto& image) {
        const auto* other = std::get_if<std::remove_cvref_t<decltype(image)>>(&b.pixels);
        const std::size_t row_bytes = sizeof(*image.row(0)) *
                                      static_cast<std::size_t>(image.width()) *
                                      static_cast<std::size_t>(image.channels());
        bool are_same = other != nullptr;
        for (int y = 0; are_same && y < image.height(); ++y) {
          are_same = std::memcmp(image.row(y), other->row(y), row_bytes) == 0;
        }
        return are_same;
      },
      a.pixels);
}

std::uint64_t content_hash(const Photograph& photograph) {
  Hash hash;
  const int shape[] = {photograph.width(), photograph.height(), photograph.channels(),
                       static_cast<int>(photograph.pixels.index())};
  hash.add(shape, sizeof shape);
  std::visit(
      [&](const auto& image) {
        const std::size_t row_bytes = sizeof(*image.row(0)) *
                                      static_cast<std::size_t>(image.width()) *
                                      static_cast<std::size_t>(image.channels());
        for (int y = 0; y < image.height(); ++y) {
          hash.add(image.row(y), row_bytes);
        }
      },
      photograph.pixels);
  return hash.value();
}

}  // namespace vantage
