#include "engine/io/files/text_lines.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr std::string_view kBetweenWords = " \t\r\v\f,";

}  // namespace

TextLines::TextLines(std::string_view text, std::string file)
    : text_(text), file_(std::move(file)), rest_(text) {
  if (text_.find('\0') != std::string_view::npos) {
    throw Error(fmt::format("{}: is not a text, expected lines of words and numbers", file_));
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) {
    rest_.remove_prefix(kByteOrderMark.size());
  }
}

std::optional<std::string_view> TextLines::next() {
  before_last_ = rest_;
  line_before_last_ = line_;
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    const std::size_t first = line.find_first_not_of(kBetweenWords);
    if (first != std::string_view::npos && line[first] == '#') {
      continue;
    }
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    return line;
  }
  return std::nullopt;
}

std::optional<std::string_view> TextLines::next_with_words() {
  while (const std::optional<std::string_view> line = next()) {
    if (line->find_first_not_of(kBetweenWords) != std::string_view::npos) {
      return line;
    }
  }
  return std::nullopt;
}

void TextLines::put_back() {
  rest_ = before_last_;
  line_ = line_before_last_;
}

void TextLines::fail(const std::string& problem) const {
  throw Error(fmt::format("{} line {}: {}", file_, line_, problem));
}

double TextLines::number(std::string_view word, std::string_view name) const {
  const std::optional<double> value = finite_number(word);
  if (!value) {
    fail(fmt::format("{} is '{}', expected a finite number", name, quotable(word)));
  }
  return *value;
}

long long TextLines::whole_number(std::string_view word, std::string_view name, long long min,
                                  long long max) const {
  long long value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end || value < min || value > max) {
    fail(fmt::format("{} is '{}', expected a whole number from {} to {}", name, quotable(word), min,
                     max));
  }
  return value;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t first = line.find_first_not_of(kBetweenWords);
    if (first == std::string_view::npos) {
      return words;
    }
    line.remove_prefix(first);
    words.push_back(line.substr(0, line.find_first_of(kBetweenWords)));
    line.remove_prefix(words.back().size());
  }
}

std::optional<double> finite_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') {
    word.remove_prefix(1);
  }
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace vantage
