#include "engine/rectification/calibration/calibration_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/io/files/json_text.h"

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
      return rest.substr(0, has_brackets ? rest.find(']') : rest.find_first_of("\n,}"));
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

/// Nodes deeper than this are not looked at.
constexpr int kMaxDepth = 6;

/// Without comments: from a # at the start of a line or after a blank.
std::string without_comments(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    for (std::size_t at = line.find('#'); at != std::string_view::npos;
         at = line.find('#', at + 1)) {
      if (at == 0 || kBlanks.find(line[at - 1]) != std::string_view::npos) {
        line = line.substr(0, at);
        break;
      }
    }
    result.append(line).push_back('\n');
  }
  return result;
}

/// Lines without the blanks before the leftmost of them.
std::string dedented(std::string_view text) {
  std::size_t indent = text.size();
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = take_line(rest);
    if (const std::size_t first = line.find_first_not_of(kBlanks); first < line.size()) {
      indent = std::min(indent, first);
    }
  }
  std::string result;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    result.append(line.substr(std::min(indent, line.size()))).push_back('\n');
  }
  return result;
}

/// The first name at the start of a line, if it is before anything else.
bool begins_with_name(std::string_view text) {
  const std::size_t first = text.find_first_not_of("\r\n");
  return first != std::string_view::npos && named(text.substr(first), ':').has_value();
}

void add_yaml(std::string_view text, const std::string& prefix, int depth,
              CalibrationEntries& entries) {
  while (!text.empty()) {
    const auto first = named(take_line(text), ':');
    if (!first) {
      continue;
    }
    // The block continues to the line before the next name.
    const char* begin = first->second.data();
    const char* end = begin + first->second.size();
    const char* second_line = text.data();
    for (std::string_view rest = text; !rest.empty();) {
      const std::string_view line = take_line(rest);
      if (named(line, ':') || line.starts_with("---") || line.starts_with("...")) {
        break;
      }
      end = line.data() + line.size();
      text = rest;
    }
    const std::string_view block(begin, static_cast<std::size_t>(end - begin));
    const std::string name = prefix + std::string(first->first);
    const std::string inner =
        depth < kMaxDepth && without_blanks(first->second).empty() && end > second_line
            ? dedented({second_line, static_cast<std::size_t>(end - second_line)})
            : std::string();
    // A matrix has its data at the first level.
    if (begins_with_name(inner) && !inner.starts_with("data:") &&
        inner.find("\ndata:") == std::string::npos) {
      add_yaml(inner, name + ".", depth + 1, entries);
    } else {
      entries.try_emplace(name, yaml_entry(block));
    }
  }
}

/// The numbers of nested lists, and how many rows the outermost has.
CalibrationEntry entry_of_json(const nlohmann::ordered_json& value) {
  if (value.is_object()) {
    const auto part = [&](const char* name) {
      return value.contains(name) ? value[name].dump() : std::string();
    };
    return matrix_of(part("rows"), part("cols"), part("data"));
  }
  CalibrationEntry entry = numbers_of(value.dump());
  if (entry.problem.empty() && value.is_array() && value[0].is_array()) {
    entry.rows = static_cast<int>(value.size());
    entry.columns = static_cast<int>(entry.values.size() / value.size());
  }
  return entry;
}

void add_json(const nlohmann::ordered_json& object, const std::string& prefix, int depth,
              CalibrationEntries& entries) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object() && !value.contains("data") && depth < kMaxDepth) {
      add_json(value, prefix + key + ".", depth + 1, entries);
    } else {
      entries.try_emplace(prefix + key, entry_of_json(value));
    }
  }
}

std::string_view element(std::string_view content, const std::string& name) {
  const std::string open = "<" + name + ">";
  const std::size_t begin = content.find(open);
  const std::size_t end = content.find("</" + name + ">");
  return begin == std::string_view::npos || end == std::string_view::npos || end < begin
             ? std::string_view{}
             : content.substr(begin + open.size(), end - begin - open.size());
}

void add_xml(std::string_view text, const std::string& prefix, int depth,
             CalibrationEntries& entries) {
  bool in_outermost = depth > 0;
  while (true) {
    const std::size_t open = text.find('<');
    if (open == std::string_view::npos) {
      return;
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
      return;
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
      entries.try_emplace(prefix + std::string(name),
                          CalibrationEntry{.problem = "is not complete"});
      return;
    }
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(end + end_tag.size());
    const std::string path = prefix + std::string(name);
    const std::string_view data = element(content, "data");
    const bool is_matrix = !data.empty() && !element(content, "rows").empty();
    if (!is_matrix && depth < kMaxDepth && content.find('<') != std::string_view::npos) {
      add_xml(content, path + ".", depth + 1, entries);
    } else {
      entries.try_emplace(
          path, is_matrix ? matrix_of(element(content, "rows"), element(content, "cols"), data)
                          : numbers_of(content));
    }
  }
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
    entry.problem = CalibrationEntry::kNoNumbers;
  }
  return entry;
}

CalibrationEntries yaml_entries(std::string_view text) {
  CalibrationEntries entries;
  add_yaml(without_comments(text), "", 0, entries);
  return entries;
}

CalibrationEntries json_entries(std::string_view text) {
  CalibrationEntries entries;
  add_json(parse_json(text, "JSON"), "", 0, entries);
  return entries;
}

CalibrationEntries entries_of(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  const std::size_t first = text.find_first_not_of(kBlanks);
  switch (first == std::string_view::npos ? 0 : text[first]) {
    case '<':
      return xml_entries(text);
    case '{':
      return json_entries(text);
    default:
      return yaml_entries(text);
  }
}

CalibrationEntries xml_entries(std::string_view text) {
  CalibrationEntries entries;
  add_xml(text, "", 0, entries);
  return entries;
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
