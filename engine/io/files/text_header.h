#pragma once

#include <cstddef>
#include <string>

#include "engine/io/files/file_bytes.h"

namespace vantage {

/// Reads the blank-separated words of PNM and PFM headers. Does not own the bytes.
class TextHeader {
 public:
  enum class Comments { kHash, kNone };

  TextHeader(const FileBytes& file, std::size_t offset, Comments comments)
      : file_(file), offset_(offset), comments_(comments) {}

  /// The next word, at most 64 characters. Throws Error at the end of the file.
  std::string word();
  /// The next word as a decimal number without sign, at most 999 999 999. `what`: its name in
  /// messages.
  int number(const char* what);
  /// Position directly after the last word.
  [[nodiscard]] std::size_t offset() const { return offset_; }
  /// Skips the blanks (and comments) before the next word; false at the end of the file.
  bool skip_blanks();

 private:
  const FileBytes& file_;
  std::size_t offset_;
  Comments comments_;
};

bool is_blank(std::uint8_t character);

}  // namespace vantage
