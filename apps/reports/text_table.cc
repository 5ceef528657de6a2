#include "apps/reports/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vantage::apps {
namespace {

/// Width in terminal columns: continuation bytes of UTF-8 have none.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

}  // namespace

TextTable::TextTable(std::string title, std::vector<std::string> heads) : title_(std::move(title)) {
  rows_.push_back(std::move(heads));
}

void TextTable::add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

std::string TextTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size());
  for (const auto& row : rows_) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      widths[column] = std::max(widths[column], width_of(row[column]));
    }
  }
  std::string text = title_ + "\n";
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t column = 0; column < row.size(); ++column) {
      const std::string gap(widths[column] - width_of(row[column]), ' ');
      line += "  " + (column == 0 ? row[column] + gap : gap + row[column]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace vantage::apps
