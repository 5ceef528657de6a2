#include "engine/io/files/text_header.h"

#include <fmt/format.h>

#include <charconv>

namespace vantage {

bool is_blank(std::uint8_t character) {
  return character == ' ' || (character >= '\t' && character <= '\r');
}

bool TextHeader::skip_blanks() {
  const auto bytes = file_.all();
  bool in_comment = false;
  while (offset_ < bytes.size()) {
    const std::uint8_t c = bytes[offset_];
    if (in_comment) {
      in_comment = c != '\n' && c != '\r';
    } else if (c == '#' && comments_ == Comments::kHash) {
      in_comment = true;
    } else if (!is_blank(c)) {
      return true;
    }
    ++offset_;
  }
  return false;
}

std::string TextHeader::word() {
  if (!skip_blanks()) {
    file_.fail("is truncated, it ends inside its text header or data");
  }
  const auto bytes = file_.all();
  std::string result;
  while (offset_ < bytes.size() && !is_blank(bytes[offset_])) {
    result.push_back(static_cast<char>(bytes[offset_]));
    if (result.size() > 64) {
      file_.fail("its header is not text");
    }
    ++offset_;
  }
  return result;
}

int TextHeader::number(const char* what) {
  const std::string text = word();
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 ||
      value > 999'999'999) {
    file_.fail(fmt::format("its {} is not a whole number", what));
  }
  return value;
}

}  // namespace vantage
