#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/error.h"

namespace vantage {

/// Maximum width or height, and maximum number of pixels of one image: beyond them a header counts
/// as damaged before any memory is allocated.
inline constexpr int kMaxImageSide = 65500;
inline constexpr long long kMaxImagePixels = 1LL << 28;

/// Maximum number of pixels of images and videos in this process: kMaxImagePixels unless set to a
/// value from 1 to that. Throws UsageError beyond. Thread rule: may be called concurrently; images
/// read at the same time have the old limit or the new one.
long long max_image_pixels();
void set_max_image_pixels(long long pixels);

/// Content of a regular file, local or at an address. Throws Error when it is missing, unreadable,
/// not a file, or empty but must not be.
std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path,
                                          bool may_be_empty = false);
/// Content of a regular file as text. Throws as read_file_bytes() does.
std::string read_file_text(const std::filesystem::path& path, bool may_be_empty = false);

/// The bytes of a file with bounds-checked access and errors that name the file. Does not own them.
class FileBytes {
 public:
  FileBytes(std::span<const std::uint8_t> bytes, std::string name)
      : bytes_(bytes), name_(std::move(name)) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::span<const std::uint8_t> all() const { return bytes_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Throws Error "<name>: <problem>".
  [[noreturn]] void fail(const std::string& problem) const { throw Error(name_ + ": " + problem); }

  /// `count` bytes from `offset`; Error "is truncated" when the file is too short.
  [[nodiscard]] std::span<const std::uint8_t> part(std::size_t offset, std::size_t count) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset) {
      fail("is truncated, the file ends after " + std::to_string(bytes_.size()) + " bytes");
    }
    return bytes_.subspan(offset, count);
  }
  [[nodiscard]] std::uint8_t byte(std::size_t offset) const { return part(offset, 1)[0]; }

  /// The unsigned integer at `offset`.
  template <std::unsigned_integral T>
  [[nodiscard]] T integer(std::size_t offset, std::endian order) const {
    T value = 0;
    const auto source = part(offset, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const std::size_t from = order == std::endian::big ? i : sizeof(T) - 1 - i;
      value = static_cast<T>(static_cast<std::uint64_t>(value) << 8 | source[from]);
    }
    return value;
  }

  [[nodiscard]] bool has_at(std::size_t offset, std::string_view text) const {
    return offset <= bytes_.size() && text.size() <= bytes_.size() - offset &&
           std::memcmp(bytes_.data() + offset, text.data(), text.size()) == 0;
  }

  /// Throws Error unless both sides are in 1..kMaxImageSide and their product is at most
  /// max_image_pixels().
  void check_dimensions(long long width, long long height) const;

 private:
  std::span<const std::uint8_t> bytes_;
  std::string name_;
};

/// Lower-case extension with its dot, "" for none.
std::string lower_case_extension(const std::filesystem::path& path);

}  // namespace vantage
