#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// 64-bit FNV-1a hash of bytes in the order in which they are added. Equal on every machine.
class Fnv1aHash {
 public:
  void add(std::string_view bytes);
  /// As eight bytes, least significant first.
  void add(std::uint64_t value);
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Detects changed files without reading them: by their number, their bytes, and a hash over name,
/// size and modification time of each, in order.
class FileIdentity {
 public:
  /// Adds a file under `name` (machines may see it at different paths). A missing file is hashed as
  /// missing.
  void add(std::string_view name, const std::filesystem::path& file);

  /// "2 files, 1234 bytes, hash 00112233445566ff"; missing files are not counted.
  [[nodiscard]] std::string to_string() const;

 private:
  int files_ = 0;
  std::uint64_t bytes_ = 0;
  Fnv1aHash hash_;
};

}  // namespace vantage
