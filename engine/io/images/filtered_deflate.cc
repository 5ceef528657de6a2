#include "engine/io/images/filtered_deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace vantage {
namespace {

constexpr std::size_t kEndOfBlock = 256;
constexpr std::size_t kSymbols = 286;  // bytes, the end, lengths of matches
/// Four codes, behind up to seven bits, fill a word of 64.
constexpr int kMaxCodeBits = 14;
/// Shorter runs are cheaper as zeros, mostly of one bit.
constexpr std::size_t kRunBlock = 16;

template <typename T>
using PerSymbol = std::array<T, kSymbols>;

/// The length of a match, 3 to 258 bytes, as symbol and further bits.
struct MatchLength {
  std::size_t symbol = 285;
  int extra_bits = 0;
  unsigned extra = 0;

  explicit MatchLength(std::size_t bytes) {
    if (bytes < 258) {
      const auto above = static_cast<unsigned>(bytes - 3);
      extra_bits = above < 8 ? 0 : std::bit_width(above) - 3;
      symbol = 257U + 4U * static_cast<unsigned>(extra_bits) + (above >> extra_bits);
      extra = above & ((1U << extra_bits) - 1);
    }
  }
};

/// Calls literals(begin, end) and match(MatchLength) for all bytes in order. Matches repeat the
/// zero before them.
template <typename Literals, typename Match>
void for_each_part(std::span<const std::uint8_t> bytes, const Literals& literals,
                   const Match& match) {
  const auto is_zero_block = [&](std::size_t i) {
    std::uint64_t words[2] = {1};
    if (i + kRunBlock <= bytes.size()) {
      std::memcpy(words, bytes.data() + i, sizeof words);
    }
    return (words[0] | words[1]) == 0;
  };
  std::size_t begin = 0;
  for (std::size_t i = 0; i + kRunBlock <= bytes.size(); i += kRunBlock) {
    if (!is_zero_block(i)) {
      continue;
    }
    std::size_t first = i;
    while (first > begin && bytes[first - 1] == 0) {
      --first;
    }
    literals(begin, first + 1);
    begin = i + kRunBlock;
    while (is_zero_block(begin)) {
      begin += kRunBlock;
    }
    while (begin < bytes.size() && bytes[begin] == 0) {
      ++begin;
    }
    for (std::size_t rest = begin - first - 1, part = 0; rest > 0; rest -= part) {
      part = rest <= 258 ? rest : std::min<std::size_t>(258, rest - 3);
      match(MatchLength(part));
    }
    i = begin / kRunBlock * kRunBlock;
  }
  literals(begin, bytes.size());
}

PerSymbol<std::uint32_t> count_symbols(std::span<const std::uint8_t> bytes) {
  PerSymbol<std::uint32_t> symbols = {};
  // Four of each, so that none is read while it is being written.
  std::array<std::array<std::uint32_t, 256>, 4> counts = {};
  for_each_part(
      bytes,
      [&](std::size_t i, std::size_t end) {
        for (; i + 8 <= end; i += 8) {
          std::uint64_t word = 0;
          std::memcpy(&word, bytes.data() + i, sizeof word);
          for (std::size_t k = 0; k < 8; ++k) {
            ++counts[k % 4][word >> (8 * k) & 0xFF];
          }
        }
        for (; i < end; ++i) {
          ++counts[0][bytes[i]];
        }
      },
      [&](MatchLength length) { ++symbols[length.symbol]; });
  for (std::size_t k = 0; k < 256; ++k) {
    symbols[k] = counts[0][k] + counts[1][k] + counts[2][k] + counts[3][k];
  }
  symbols[kEndOfBlock] = 1;
  return symbols;
}

/// Huffman's code lengths; counts that make them too long are halved until they fit.
PerSymbol<std::uint8_t> code_lengths(PerSymbol<std::uint32_t> counts) {
  for (;;) {
    struct Node {
      std::uint64_t weight = 0;
      std::size_t symbol = 0;
      std::size_t parent = 0;
      std::uint8_t depth = 0;
    };
    std::array<Node, 2 * kSymbols> nodes = {};  // leaves by weight, then joined ones
    std::size_t leaves = 0;
    for (std::size_t k = 0; k < kSymbols; ++k) {
      if (counts[k] > 0) {
        nodes[leaves++] = {.weight = counts[k], .symbol = k};
      }
    }
    std::stable_sort(nodes.begin(), nodes.begin() + leaves,
                     [](const Node& a, const Node& b) { return a.weight < b.weight; });
    std::size_t leaf = 0;
    std::size_t joined = leaves;
    const std::size_t root = 2 * leaves - 2;
    for (std::size_t node = leaves; node <= root; ++node) {
      for (int child = 0; child < 2; ++child) {
        const bool is_leaf =
            leaf < leaves && (joined == node || nodes[leaf].weight <= nodes[joined].weight);
        Node& lightest = nodes[is_leaf ? leaf++ : joined++];
        lightest.parent = node;
        nodes[node].weight += lightest.weight;
      }
    }
    PerSymbol<std::uint8_t> lengths = {};
    for (std::size_t node = root; node-- > 0;) {
      nodes[node].depth = static_cast<std::uint8_t>(nodes[nodes[node].parent].depth + 1);
      if (node < leaves) {
        lengths[nodes[node].symbol] = nodes[node].depth;
      }
    }
    if (nodes[0].depth <= kMaxCodeBits) {
      return lengths;
    }
    for (std::uint32_t& count : counts) {
      count = (count + 1) / 2;
    }
  }
}

struct Code {
  std::uint16_t bits = 0;  ///< the first one lowest
  std::uint16_t length = 0;
};

/// The canonical code of `lengths`.
PerSymbol<Code> codes_of(const PerSymbol<std::uint8_t>& lengths) {
  PerSymbol<Code> codes = {};
  unsigned next = 0;
  for (int length = 1; length <= kMaxCodeBits; ++length, next *= 2) {
    for (std::size_t k = 0; k < kSymbols; ++k) {
      if (lengths[k] == length) {
        for (int bit = 0; bit < length; ++bit) {
          codes[k].bits |= static_cast<std::uint16_t>((next >> bit & 1U) << (length - 1 - bit));
        }
        codes[k].length = static_cast<std::uint16_t>(length);
        ++next;
      }
    }
  }
  return codes;
}

/// Writes bits, the first lowest. Eight bytes behind the last must be there.
class BitWriter {
 public:
  explicit BitWriter(std::uint8_t* next) : next_(next) {}

  /// At most 57 bits between two calls of store().
  void add(std::uint64_t bits, int count) {
    word_ |= bits << count_;
    count_ += count;
  }
  void store() {
    std::memcpy(next_, &word_, sizeof word_);
    next_ += count_ >> 3;
    word_ >>= count_ & ~7;
    count_ &= 7;
  }
  void put(std::uint64_t bits, int count) {
    add(bits, count);
    store();
  }
  void put(Code code) { put(code.bits, code.length); }
  /// The end of the bytes, the last filled up with zeros.
  std::uint8_t* end() {
    put(0, 7);
    return next_;
  }

 private:
  std::uint8_t* next_;
  std::uint64_t word_ = 0;
  int count_ = 0;
};

/// All code lengths with four bits each: 160 bytes.
void put_block_start(const PerSymbol<std::uint8_t>& lengths, bool is_last, BitWriter& out) {
  constexpr unsigned kDynamicCodes = 2;
  out.put((is_last ? 1U : 0U) | kDynamicCodes << 1U, 3);
  out.put(kSymbols - 257, 5);
  out.put(0, 5);       // one distance
  out.put(19 - 4, 4);  // lengths of all code lengths, first of three symbols for repetitions
  for (int k = 0; k < 19; ++k) {
    out.put(k < 3 ? 0 : 4, 3);
  }
  constexpr std::uint8_t kReversed[] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  for (const std::uint8_t length : lengths) {
    out.put(kReversed[length], 4);
  }
  out.put(kReversed[1], 4);  // of the distance
}

void put_symbols(std::span<const std::uint8_t> bytes, const PerSymbol<Code>& codes,
                 BitWriter& out) {
  for_each_part(
      bytes,
      [&](std::size_t i, std::size_t end) {
        BitWriter writer = out;  // in registers
        for (; i + 4 <= end; i += 4) {
          for (std::size_t k = 0; k < 4; ++k) {
            writer.add(codes[bytes[i + k]].bits, codes[bytes[i + k]].length);
          }
          writer.store();
        }
        for (; i < end; ++i) {
          writer.put(codes[bytes[i]]);
        }
        out = writer;
      },
      [&](MatchLength length) {
        out.put(codes[length.symbol]);
        out.put(length.extra, length.extra_bits + 1);  // and the distance
      });
  out.put(codes[kEndOfBlock]);
}

}  // namespace

void append_deflated(std::span<const std::uint8_t> bytes, bool ends_stream,
                     std::vector<std::uint8_t>& stream) {
  const PerSymbol<std::uint32_t> counts = count_symbols(bytes);
  const PerSymbol<std::uint8_t> lengths = code_lengths(counts);
  std::size_t bits = 2048;  // the start of the block, and what is written behind its end
  for (std::size_t k = 0; k < kSymbols; ++k) {
    const std::size_t of_match = k > kEndOfBlock ? 6 : 0;  // further bits and distance, at most
    bits += std::size_t{counts[k]} * (lengths[k] + of_match);
  }
  const std::size_t before = stream.size();
  stream.resize(before + bits / 8);
  BitWriter out(stream.data() + before);
  put_block_start(lengths, ends_stream, out);
  put_symbols(bytes, codes_of(lengths), out);
  if (!ends_stream) {
    out.put(0, 3);  // a stored block, which begins at a whole byte
  }
  stream.resize(static_cast<std::size_t>(out.end() - stream.data()));
  if (!ends_stream) {
    constexpr std::uint8_t kOfNothing[] = {0, 0, 0xFF, 0xFF};
    stream.insert(stream.end(), std::begin(kOfNothing), std::end(kOfNothing));
  }
}

}  // namespace vantage
