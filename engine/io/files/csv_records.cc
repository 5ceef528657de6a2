#include "engine/io/files/csv_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

bool ends_line(char c) { return c == '\n' || c == '\r'; }

}  // namespace

bool equals_ignoring_case(std::string_view text, std::string_view lower_case) {
  if (text.size() != lower_case.size()) {
    return false;
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_upper = text[i] >= 'A' && text[i] <= 'Z';
    if ((is_upper ? static_cast<char>(text[i] - 'A' + 'a') : text[i]) != lower_case[i]) {
      return false;
    }
  }
  return true;
}

CsvRecords::CsvRecords(std::string_view text, std::string file, char separator)
    : text_(text), file_(std::move(file)), separator_(separator) {
  if (text.find('\0') != std::string_view::npos) {
    throw Error(fmt::format("{}: holds a zero byte, expected UTF-8 text", file_));
  }
  if (text_.starts_with("\xEF\xBB\xBF")) {
    position_ = 3;
  }
}

bool CsvRecords::next(std::vector<std::string>& fields) {
  fields.clear();
  skip_lines_without_record();
  if (at_end()) {
    return false;
  }
  record_line_ = line_;
  fields.push_back(read_field());
  while (!at_end() && text_[position_] == separator_) {
    ++position_;
    if (separator_ == ' ') {
      skip_blanks();
      if (at_end() || ends_line(text_[position_])) {
        break;
      }
    }
    fields.push_back(read_field());
  }
  skip_line_end();
  return true;
}

void CsvRecords::fail(int line, const std::string& problem) const {
  throw Error(fmt::format("{} line {}: {}", file_, line, problem));
}

void CsvRecords::skip_blanks() {
  while (!at_end() && is_blank(text_[position_])) {
    ++position_;
  }
}

void CsvRecords::skip_line_end() {
  if (at_end()) {
    return;
  }
  position_ += text_.substr(position_).starts_with("\r\n") ? 2 : 1;
  ++line_;
}

void CsvRecords::skip_lines_without_record() {
  for (;;) {
    if (!at_end() && text_[position_] == '#') {
      position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
    }
    skip_blanks();
    if (at_end() || !ends_line(text_[position_])) {
      return;
    }
    skip_line_end();
  }
}

// Ends at a separator, the end of the line or the end of the text.
std::string CsvRecords::read_field() {
  skip_blanks();
  return !at_end() && text_[position_] == '"' ? read_quoted() : read_unquoted();
}

std::string CsvRecords::read_unquoted() {
  const char ends[] = {separator_, '\r', '\n', '\0'};
  const std::size_t end = std::min(text_.find_first_of(ends, position_), text_.size());
  std::string_view field = text_.substr(position_, end - position_);
  position_ = end;
  while (!field.empty() && is_blank(field.back())) {
    field.remove_suffix(1);
  }
  if (field.find('"') != std::string_view::npos) {
    fail(line_,
         fmt::format("a quote inside of '{}', expected \"\" in a quoted name", quotable(field)));
  }
  return std::string(field);
}

std::string CsvRecords::read_quoted() {
  const int first_line = line_;
  std::string field;
  for (++position_;; ++position_) {
    if (at_end()) {
      fail(first_line, "a quote is not closed");
    }
    const char c = text_[position_];
    if (c == '"') {
      if (!text_.substr(position_).starts_with("\"\"")) {
        break;
      }
      ++position_;
    }
    const bool is_first_of_two = c == '\r' && text_.substr(position_).starts_with("\r\n");
    line_ += ends_line(c) && !is_first_of_two ? 1 : 0;
    field.push_back(c);
  }
  ++position_;
  if (separator_ != ' ') {
    skip_blanks();
  }
  if (!at_end() && text_[position_] != separator_ && !ends_line(text_[position_])) {
    fail(line_, "text after a closing quote, expected a separator or the end of the line");
  }
  return field;
}

}  // namespace vantage
