#include "engine/io/images/png_encoder.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <string_view>

#include "engine/io/files/checksum.h"

namespace vantage {
namespace {

constexpr int kMaxSide = 1'000'000;
constexpr std::uint8_t kFilterSub = 1;
/// A chunk may hold up to 2³¹ − 1 bytes.
constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 30;

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

/// The bytes of a row in the order of the file.
void put_row(const std::uint8_t* values, std::size_t count, std::uint8_t* bytes) {
  std::copy_n(values, count, bytes);
}
void put_row(const std::uint16_t* values, std::size_t count, std::uint8_t* bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(values[i] >> 8);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(values[i]);
  }
}

/// Each byte minus that of the pixel before: the fastest filter for photographs and maps, with
/// nearly the best compression.
void subtract_previous(const std::uint8_t* row, std::size_t count, std::size_t pixel_bytes,
                       std::uint8_t* __restrict filtered) {
  std::copy_n(row, pixel_bytes, filtered);
  for (std::size_t i = pixel_bytes; i < count; ++i) {
    filtered[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel_bytes]);
  }
}

/// All rows, each preceded by the number of its filter.
template <typename T>
void filter_rows(const Image<T>& image, std::span<std::uint8_t> filtered) {
  const std::size_t values =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
  const std::size_t pixel_bytes = static_cast<std::size_t>(image.channels()) * sizeof(T);
  std::vector<std::uint8_t> row(values * sizeof(T));
  std::uint8_t* next = filtered.data();
  for (int y = 0; y < image.height(); ++y) {
    put_row(image.row(y), values, row.data());
    *next++ = kFilterSub;
    subtract_previous(row.data(), row.size(), pixel_bytes, next);
    next += row.size();
  }
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
  }
};

/// The zlib stream of all rows.
template <typename T>
struct CompressedRows {
  std::unique_ptr<std::uint8_t[]> memory;
  std::size_t size = 0;

  explicit CompressedRows(const Image<T>& image) {
    constexpr int kFastest = 1;
    const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
        libdeflate_alloc_compressor(kFastest));
    if (!compressor) {
      throw std::bad_alloc();
    }
    const std::size_t row_bytes = 1 + static_cast<std::size_t>(image.width()) *
                                          static_cast<std::size_t>(image.channels()) * sizeof(T);
    const std::size_t count = row_bytes * static_cast<std::size_t>(image.height());
    const auto filtered = std::make_unique_for_overwrite<std::uint8_t[]>(count);
    filter_rows(image, {filtered.get(), count});
    const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), count);
    memory = std::make_unique_for_overwrite<std::uint8_t[]>(bound);
    size = libdeflate_zlib_compress(compressor.get(), filtered.get(), count, memory.get(), bound);
  }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return {memory.get(), size}; }
};

template <typename T>
void encode(const Image<T>& image, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  if (std::max(image.width(), image.height()) > kMaxSide) {
    return;
  }
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::uint8_t kGrey = 0;
  constexpr std::uint8_t kRgb = 2;
  constexpr std::uint8_t kRgba = 6;
  std::array<std::uint8_t, 13> header = {};  // no interlacing
  std::ranges::copy(big_endian(static_cast<std::size_t>(image.width())), header.begin());
  std::ranges::copy(big_endian(static_cast<std::size_t>(image.height())), header.begin() + 4);
  header[8] = 8 * sizeof(T);
  header[9] = image.channels() == 1 ? kGrey : image.channels() == 3 ? kRgb : kRgba;
  const CompressedRows<T> rows(image);
  append(kSignature, bytes);
  append_chunk("IHDR", header, bytes);
  for (std::span<const std::uint8_t> rest = rows.bytes(); !rest.empty();) {
    const std::size_t size = std::min(rest.size(), kMaxChunkBytes);
    append_chunk("IDAT", rest.first(size), bytes);
    rest = rest.subspan(size);
  }
  append_chunk("IEND", {}, bytes);
}

}  // namespace

void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes) {
  encode(image, bytes);
}

void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes) {
  encode(image, bytes);
}

}  // namespace vantage
