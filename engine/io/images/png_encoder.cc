#include "engine/io/images/png_encoder.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>

#include "engine/execution.h"
#include "engine/io/files/checksum.h"
#include "engine/io/images/filtered_deflate.h"

namespace vantage {
namespace {

constexpr int kMaxSide = 1'000'000;
/// Strips have about so many bytes: they stay in the cache, and their codes take little of them.
constexpr std::size_t kStripBytes = std::size_t{1} << 18U;

std::array<std::uint8_t, 4> big_endian(std::size_t value) {
  return {static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
          static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
}

void append(std::span<const std::uint8_t> part, std::vector<std::uint8_t>& bytes) {
  bytes.insert(bytes.end(), part.begin(), part.end());
}

void append_chunk(std::string_view name, std::span<const std::uint8_t> content,
                  std::vector<std::uint8_t>& bytes) {
  append(big_endian(content.size()), bytes);
  const std::size_t checked = bytes.size();
  bytes.insert(bytes.end(), name.begin(), name.end());
  append(content, bytes);
  append(big_endian(crc32_of(std::span(bytes).subspan(checked))), bytes);
}

/// The Adler-32 of two parts, one after the other.
std::uint32_t joined_adler32(std::uint32_t first, std::uint32_t second, std::size_t second_bytes) {
  constexpr std::uint64_t kPrime = 65521;
  const std::uint64_t before = (first & 0xFFFFU) + kPrime - 1;
  const std::uint64_t low = before + (second & 0xFFFFU);
  const std::uint64_t high = (first >> 16U) + (second >> 16U) + second_bytes % kPrime * before;
  return static_cast<std::uint32_t>(high % kPrime << 16U | low % kPrime);
}

/// PNG's filter Paeth: a byte minus that of its left, upper or upper left neighbour, whichever is
/// nearest to left + upper − upper left. The smallest files, of masks by half.
struct PaethFilter {
  static constexpr std::uint8_t kNumber = 4;
  static void apply(const std::uint8_t* row, const std::uint8_t* above, std::size_t count,
                    std::size_t channels, std::uint8_t* __restrict filtered) {
    for (std::size_t i = 0; i < channels; ++i) {
      filtered[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    }
    for (std::size_t i = channels; i < count; ++i) {
      const short left = row[i - channels];
      const short up = above[i];
      const short corner = above[i - channels];
      const auto to_left = static_cast<short>(std::abs(up - corner));
      const auto to_up = static_cast<short>(std::abs(left - corner));
      const auto to_corner = static_cast<short>(std::abs(left + up - 2 * corner));
      const short of_row_above = to_up <= to_corner ? up : corner;
      const bool is_left = to_left <= to_up && to_left <= to_corner;
      filtered[i] = static_cast<std::uint8_t>(row[i] - (is_left ? left : of_row_above));
    }
  }
};

/// PNG's filter Sub: a byte minus that of the pixel before, the higher of a value first. Paeth
/// makes maps smaller by 7 %, but libpng undoes it for two bytes a pixel without vectors.
struct SubFilter {
  static constexpr std::uint8_t kNumber = 1;
  static void apply(const std::uint16_t* row, const std::uint16_t* /*above*/, std::size_t count,
                    std::size_t channels, std::uint8_t* __restrict filtered) {
    for (std::size_t i = 0; i < count; ++i) {
      const unsigned before = i < channels ? 0 : row[i - channels];
      filtered[2 * i] = static_cast<std::uint8_t>((row[i] >> 8U) - (before >> 8U));
      filtered[2 * i + 1] = static_cast<std::uint8_t>(row[i] - before);
    }
  }
};

template <typename T>
using Filter = std::conditional_t<sizeof(T) == 1, PaethFilter, SubFilter>;

struct PngShape {
  int width = 0;
  int height = 0;
  int channels = 1;
  [[nodiscard]] std::size_t row_values() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
};

struct Strip {
  std::size_t bytes = 0;  ///< of its filtered rows
  std::uint32_t adler32 = 0;
  std::vector<std::uint8_t> deflated = {};
};

/// The strip of rows [first, end), each behind the number of its filter.
template <typename T, typename RowSource>
Strip make_strip(PngShape shape, const RowSource& row, int first, int end) {
  const std::size_t values = shape.row_values();
  const std::size_t row_bytes = 1 + values * sizeof(T);
  Strip strip{.bytes = row_bytes * static_cast<std::size_t>(end - first)};
  const auto filtered = std::make_unique_for_overwrite<std::uint8_t[]>(strip.bytes);
  const auto memory = std::make_unique<T[]>(values);
  const T* above = first > 0 ? row(first - 1, memory.get()) : memory.get();
  std::uint8_t* next = filtered.get();
  for (int y = first; y < end; ++y, next += row_bytes) {
    const T* const values_of_row = row(y, memory.get());
    *next = Filter<T>::kNumber;
    Filter<T>::apply(values_of_row, above, values, static_cast<std::size_t>(shape.channels),
                     next + 1);
    above = values_of_row;
  }
  const std::span<const std::uint8_t> bytes(filtered.get(), strip.bytes);
  constexpr std::array<std::uint8_t, 2> kZlibHeader = {0x78, 0x01};
  if (first == 0) {
    append(kZlibHeader, strip.deflated);
  }
  append_deflated(bytes, end == shape.height, strip.deflated);
  strip.adler32 = libdeflate_adler32(1, bytes.data(), bytes.size());
  return strip;
}

template <typename T, typename RowSource>
void encode(PngShape shape, const RowSource& row, std::vector<std::uint8_t>& bytes,
            Execution* execution) {
  bytes.clear();
  if (std::max(shape.width, shape.height) > kMaxSide) {
    return;
  }
  const std::size_t row_bytes = 1 + shape.row_values() * sizeof(T);
  const int strip_rows = static_cast<int>(std::max<std::size_t>(1, kStripBytes / row_bytes));
  std::vector<Strip> strips(static_cast<std::size_t>((shape.height + strip_rows - 1) / strip_rows));
  const auto make = [&](int index) {
    const int first = index * strip_rows;
    strips[static_cast<std::size_t>(index)] =
        make_strip<T>(shape, row, first, std::min(first + strip_rows, shape.height));
  };
  if (execution != nullptr) {
    execution->executor().parallel_for(static_cast<int>(strips.size()), make);
  } else {
    for (int index = 0; index < static_cast<int>(strips.size()); ++index) {
      make(index);
    }
  }

  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::uint8_t kGrey = 0;
  constexpr std::uint8_t kRgb = 2;
  constexpr std::uint8_t kRgba = 6;
  std::array<std::uint8_t, 13> header = {};  // no interlacing
  std::ranges::copy(big_endian(static_cast<std::size_t>(shape.width)), header.begin());
  std::ranges::copy(big_endian(static_cast<std::size_t>(shape.height)), header.begin() + 4);
  header[8] = 8 * sizeof(T);
  header[9] = shape.channels == 1 ? kGrey : shape.channels == 3 ? kRgb : kRgba;
  append(kSignature, bytes);
  append_chunk("IHDR", header, bytes);
  std::uint32_t adler32 = 1;
  for (const Strip& strip : strips) {
    append_chunk("IDAT", strip.deflated, bytes);
    adler32 = joined_adler32(adler32, strip.adler32, strip.bytes);
  }
  append_chunk("IDAT", big_endian(adler32), bytes);
  append_chunk("IEND", {}, bytes);
}

template <typename T>
void encode(const Image<T>& image, std::vector<std::uint8_t>& bytes, Execution* execution) {
  encode<T>(
      {image.width(), image.height(), image.channels()},
      [&](int y, T* /*memory*/) { return image.row(y); }, bytes, execution);
}

}  // namespace

void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes,
                Execution* execution) {
  encode(image, bytes, execution);
}

void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes,
                Execution* execution) {
  encode(image, bytes, execution);
}

void encode_png(int width, int height, const PngRowSource& row, std::vector<std::uint8_t>& bytes,
                Execution* execution) {
  encode<std::uint16_t>({width, height}, row, bytes, execution);
}

}  // namespace vantage
