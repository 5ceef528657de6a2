#pragma once

#include <string>
#include <vector>

namespace vantage {

/// A table of a page. Texts of columns and the caption are plain; cells are markup.
struct PageTable {
  struct Column {
    std::string title;
    bool is_number = true;  ///< to the right, digits below each other
  };
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< the first cell names the row
};

/// An HTML table.
std::string table_markup(const PageTable& table);

/// A bar that fills `share` (0..1) of its cell, with `text` (plain) beside it.
std::string bar_cell(double share, const std::string& text);

}  // namespace vantage
