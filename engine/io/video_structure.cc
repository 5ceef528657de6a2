#include "engine/io/video_structure.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "engine/error.h"

namespace vantage {
namespace {

/// Reads a few bytes here and there of a file too large to load.
class SparseFile {
 public:
  explicit SparseFile(const std::filesystem::path& path)
      : path_(path), stream_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  [[nodiscard]] std::uint64_t size() const { return size_; }

  [[noreturn]] void fail_truncated() const {
    throw Error(fmt::format("{}: is truncated, the video file ends after {} bytes before its end",
                            path_.string(), size_));
  }

  std::uint64_t big_endian(std::uint64_t offset, int bytes) {
    std::uint64_t value = 0;
    for (const char c : text(offset, bytes)) {
      value = value << 8 | static_cast<unsigned char>(c);
    }
    return value;
  }

  /// `count` ≤ 8 bytes.
  std::string_view text(std::uint64_t offset, int count) {
    if (offset + static_cast<std::uint64_t>(count) > size_) {
      fail_truncated();
    }
    stream_.seekg(static_cast<std::streamoff>(offset));
    if (!stream_.read(buffer_.data(), count)) {
      throw Error(fmt::format("cannot read {}", path_.string()));
    }
    return {buffer_.data(), static_cast<std::size_t>(count)};
  }

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_;
  std::array<char, 8> buffer_{};
};

void check_boxes(SparseFile& file) {
  for (std::uint64_t offset = 0; offset < file.size();) {
    std::uint64_t length = file.big_endian(offset, 4);
    if (length == 0) {
      return;  // a last box that reaches to the end of the file, however long that is
    }
    if (length == 1) {
      length = file.big_endian(offset + 8, 8);
    }
    if (length < 8 || length > file.size() - offset) {
      file.fail_truncated();
    }
    offset += length;
  }
}

/// Value of an EBML length at `offset`; `bytes` becomes how many bytes it takes.
std::uint64_t ebml_length(SparseFile& file, std::uint64_t offset, int& bytes, bool& unknown) {
  const auto first = static_cast<std::uint8_t>(file.big_endian(offset, 1));
  bytes = std::countl_zero(first) + 1;
  if (bytes > 8) {
    file.fail_truncated();
  }
  const std::uint64_t mask = (std::uint64_t{1} << (7 * bytes)) - 1;
  const std::uint64_t value = file.big_endian(offset, bytes) & mask;
  unknown = value == mask;
  return value;
}

void check_matroska(SparseFile& file) {
  int length_bytes = 0;
  bool unknown = false;
  const std::uint64_t header = ebml_length(file, 4, length_bytes, unknown);
  const std::uint64_t segment = 4 + static_cast<std::uint64_t>(length_bytes) + header;
  if (segment > file.size() || file.text(segment, 4) != "\x18\x53\x80\x67") {
    return;
  }
  const std::uint64_t length = ebml_length(file, segment + 4, length_bytes, unknown);
  const std::uint64_t begin = segment + 4 + static_cast<std::uint64_t>(length_bytes);
  if (!unknown && (begin > file.size() || length > file.size() - begin)) {
    file.fail_truncated();
  }
}

}  // namespace

void check_video_is_whole(const std::filesystem::path& path) {
  SparseFile file(path);
  if (file.size() < 12) {
    return;
  }
  if (file.text(4, 4) == "ftyp") {
    check_boxes(file);
  } else if (file.text(0, 4) == "\x1A\x45\xDF\xA3") {
    check_matroska(file);
  } else if (file.text(0, 4) == "RIFF" && file.text(8, 4) == "AVI ") {
    const auto length = __builtin_bswap32(static_cast<std::uint32_t>(file.big_endian(4, 4)));
    if (length + std::uint64_t{8} > file.size()) {
      file.fail_truncated();
    }
  }
}

}  // namespace vantage
