#include "engine/rectification/calibration_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace vantage {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string_view::npos
             ? std::string_view{}
             : text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string without_quotes(std::string text) {
  std::erase_if(text, [](char c) { return c == '"' || c == '\''; });
  return text;
}

/// The next line without its end; removes it from `text`.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.';
}

/// The name before `separator` at the start of a line, and the text after it; none if the line
/// starts otherwise.
std::optional<std::pair<std::string_view, std::string_view>> named(std::string_view line,
                                                                   char separator) {
  std::size_t end = 0;
  while (end < line.size() && is_name_character(line[end])) {
    ++end;
  }
  const std::size_t next = line.find_first_not_of(" \t", end);
  if (end == 0 || next == std::string_view::npos || line[next] != separator) {
    return std::nullopt;
  }
  return std::pair{line.substr(0, end), line.substr(next + 1)};
}

int dimension_of(std::string_view text) {
  const CalibrationEntry number = numbers_of(text);
  const bool is_small =
      number.values.size() == 1 && number.values[0] >= 1 && number.values[0] <= 1000;
  return is_small ? static_cast<int>(number.values[0]) : 0;
}

/// A matrix from the texts of its parts.
CalibrationEntry matrix_of(std::string_view rows, std::string_view columns, std::string_view data) {
  CalibrationEntry entry = numbers_of(data);
  entry.rows = dimension_of(rows);
  entry.columns = dimension_of(columns);
  if (entry.problem.empty() && entry.values.size() != static_cast<std::size_t>(entry.rows) *
                                                          static_cast<std::size_t>(entry.columns)) {
    entry.problem =
        fmt::format("holds {} numbers, which are not its rows x cols", entry.values.size());
    entry.values.clear();
  }
  return entry;
}

/// The text after `name:` in a block, up to the end of the line or of its brackets.
std::optional<std::string_view> block_part(std::string_view block, std::string_view name) {
  for (std::size_t at = block.find(name); at != std::string_view::npos;
       at = block.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool is_word = at == 0 || !is_name_character(block[at - 1]);
    if (is_word && end < block.size() && block[end] == ':') {
      std::string_view rest = block.substr(end + 1);
      const std::size_t first = rest.find_first_not_of(kBlanks);
      const bool has_brackets = first != std::string_view::npos && rest[first] == '[';
      return rest.substr(0, rest.find(has_brackets ? ']' : '\n'));
    }
  }
  return std::nullopt;
}

CalibrationEntry yaml_entry(std::string_view block) {
  const auto data = block_part(block, "data");
  return data ? matrix_of(block_part(block, "rows").value_or(""),
                          block_part(block, "cols").value_or(""), *data)
              : numbers_of(block);
}

std::string_view element(std::string_view content, const std::string& name) {
  const std::string open = "<" + name + ">";
  const std::size_t begin = content.find(open);
  const std::size_t end = content.find("</" + name + ">");
  return begin == std::string_view::npos || end == std::string_view::npos || end < begin
             ? std::string_view{}
             : content.substr(begin + open.size(), end - begin - open.size());
}

}  // namespace

CalibrationEntry numbers_of(std::string_view text) {
  constexpr std::string_view kSeparators = " \t\r\n\v\f,;[]";
  CalibrationEntry entry;
  while (true) {
    const std::size_t begin = text.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) {
      break;
    }
    text.remove_prefix(begin);
    std::string_view word = text.substr(0, text.find_first_of(kSeparators));
    text.remove_prefix(word.size());
    if (word == "-") {
      continue;  // an item of a YAML sequence, one per line
    }
    if (word.size() > 1 && word[0] == '+') {
      word.remove_prefix(1);
    }
    constexpr std::size_t kLongestNumber = 64;
    double value = 0;
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + std::min(word.size(), kLongestNumber), value);
    if (word.size() > kLongestNumber || error != std::errc() || end != word.data() + word.size() ||
        !std::isfinite(value)) {
      std::string shown;
      for (const char c : word.substr(0, 20)) {
        shown.push_back(c >= ' ' && c <= '~' ? c : '?');
      }
      return {.problem = fmt::format("holds '{}', expected finite numbers", shown),
              .word = without_quotes(shown)};
    }
    entry.values.push_back(value);
  }
  if (entry.values.empty()) {
    entry.problem = "holds no numbers";
  }
  return entry;
}

CalibrationEntries yaml_entries(std::string_view text) {
  CalibrationEntries entries;
  while (!text.empty()) {
    const auto first = named(take_line(text), ':');
    if (!first) {
      continue;
    }
    // The block continues to the line before the next name.
    const char* begin = first->second.data();
    const char* end = begin + first->second.size();
    for (std::string_view rest = text; !rest.empty();) {
      const std::string_view line = take_line(rest);
      if (named(line, ':') || line.starts_with("---") || line.starts_with("...")) {
        break;
      }
      end = line.data() + line.size();
      text = rest;
    }
    const std::string_view block(begin, static_cast<std::size_t>(end - begin));
    entries.try_emplace(std::string(first->first), yaml_entry(block));
  }
  return entries;
}

CalibrationEntries xml_entries(std::string_view text) {
  CalibrationEntries entries;
  bool in_outermost = false;
  while (true) {
    const std::size_t open = text.find('<');
    if (open == std::string_view::npos) {
      return entries;
    }
    text.remove_prefix(open + 1);
    if (text.starts_with("!--")) {
      const std::size_t end = text.find("-->");
      text.remove_prefix(end == std::string_view::npos ? text.size() : end);
      continue;
    }
    if (text.starts_with("?") || text.starts_with("!") || text.starts_with("/")) {
      continue;
    }
    const std::size_t close = text.find('>');
    if (close == std::string_view::npos) {
      return entries;
    }
    const std::string_view tag = text.substr(0, close);
    const std::string_view name = tag.substr(0, tag.find_first_of(kBlanks));
    text.remove_prefix(close + 1);
    if (!in_outermost) {
      in_outermost = true;
      continue;
    }
    if (tag.ends_with('/')) {
      continue;
    }
    const std::string end_tag = fmt::format("</{}>", name);
    const std::size_t end = text.find(end_tag);
    if (end == std::string_view::npos) {
      entries.try_emplace(std::string(name), CalibrationEntry{.problem = "is not complete"});
      return entries;
    }
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(end + end_tag.size());
    const std::string_view data = element(content, "data");
    entries.try_emplace(std::string(name),
                        data.empty()
                            ? numbers_of(content)
                            : matrix_of(element(content, "rows"), element(content, "cols"), data));
  }
}

CalibrationEntries assignment_entries(std::string_view text) {
  CalibrationEntries entries;
  while (!text.empty()) {
    if (const auto line = named(without_blanks(take_line(text)), '=')) {
      entries.try_emplace(std::string(line->first), numbers_of(line->second));
    }
  }
  return entries;
}

}  // namespace vantage
