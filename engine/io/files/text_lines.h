#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Reads a text line by line, without comments: lines whose first visible character is #. Lines end
/// with LF or CRLF; skips a byte order mark. Thread rule: one thread at a time.
class TextLines {
 public:
  /// `text` must outlive this object. `file`: its name in messages. Throws Error for text with a
  /// zero byte.
  TextLines(std::string_view text, std::string file);

  /// The next line, which may be blank; empty at the end.
  std::optional<std::string_view> next();
  /// The next line that is not blank.
  std::optional<std::string_view> next_with_words();
  /// Returns the last line once more with the next call of next().
  void put_back();

  /// Number of the last line, counted from 1.
  [[nodiscard]] int line() const { return line_; }
  /// Throws Error "FILE line LINE: PROBLEM".
  [[noreturn]] void fail(const std::string& problem) const;
  /// `word` as a finite number; fail() with `name` otherwise.
  [[nodiscard]] double number(std::string_view word, std::string_view name) const;
  /// Likewise, as a whole number from `min` to `max`.
  [[nodiscard]] long long whole_number(std::string_view word, std::string_view name, long long min,
                                       long long max) const;

 private:
  std::string_view text_;
  std::string file_;
  std::string_view rest_;
  std::string_view before_last_;  // rest_ before the last line
  int line_ = 0;
  int line_before_last_ = 0;
};

/// The words of a line: separated by blanks or commas.
std::vector<std::string_view> words_of(std::string_view line);

/// A word that is one finite decimal number, such as -1.5e-3.
std::optional<double> finite_number(std::string_view word);

}  // namespace vantage
