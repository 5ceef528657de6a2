#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Reads values separated by commas, or another character, record by record. Fields may be quoted
/// ("" is a quote in one); skips blanks around them, empty lines, lines that start with # and a
/// byte order mark. Lines end with LF, CRLF or CR. Thread rule: one thread at a time.
class CsvRecords {
 public:
  /// `text` must outlive this object. `file`: its name in messages. A blank as `separator` is any
  /// number of them. Throws Error for text with a zero byte.
  CsvRecords(std::string_view text, std::string file, char separator = ',');

  /// The fields of the next record; false at the end. Throws Error naming file and line for a
  /// misplaced quote.
  bool next(std::vector<std::string>& fields);

  /// First line of the record of the last next(), counted from 1.
  [[nodiscard]] int record_line() const { return record_line_; }

  /// Throws Error "<file> line <line>: <problem>".
  [[noreturn]] void fail(int line, const std::string& problem) const;

 private:
  [[nodiscard]] bool at_end() const { return position_ == text_.size(); }
  [[nodiscard]] bool is_blank(char c) const {
    return c == ' ' || (c == '\t' && separator_ != '\t');
  }
  void skip_blanks();
  void skip_line_end();
  void skip_lines_without_record();
  std::string read_field();
  std::string read_unquoted();
  std::string read_quoted();

  std::string_view text_;
  std::string file_;
  char separator_;
  std::size_t position_ = 0;
  int line_ = 1;
  int record_line_ = 1;
};

/// Whether `text` equals `lower_case`, ignoring the case of ASCII letters.
bool equals_ignoring_case(std::string_view text, std::string_view lower_case);

}  // namespace vantage
