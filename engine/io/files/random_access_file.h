#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace vantage {

/// A file of which parts are read. Thread rule: one thread at a time.
class RandomAccessFile {
 public:
  RandomAccessFile() = default;
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;
  virtual ~RandomAccessFile() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `bytes` from byte `offset` of the file on; returns how many, fewer only at its end.
  /// Throws Error naming the file.
  virtual std::size_t read(std::uint64_t offset, std::span<std::uint8_t> bytes) = 0;
};

/// Opens a local file, or one at an address. Throws Error.
std::unique_ptr<RandomAccessFile> open_random_access(const std::filesystem::path& file);

}  // namespace vantage
