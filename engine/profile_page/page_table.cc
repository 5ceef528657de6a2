#include "engine/profile_page/page_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/io/markup_text.h"

namespace vantage {

std::string table_markup(const PageTable& table) {
  std::string result = "<table>\n";
  if (!table.caption.empty()) {
    result += fmt::format("<caption>{}</caption>\n", escaped_markup(table.caption));
  }
  result += "<thead><tr>";
  for (const PageTable::Column& column : table.columns) {
    result +=
        fmt::format("<th scope=\"col\"{}>{}</th>", column.is_number ? " class=\"number\"" : "",
                    escaped_markup(column.title));
  }
  result += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    result += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_number = i < table.columns.size() && table.columns[i].is_number;
      const std::string_view place = is_number ? " class=\"number\"" : "";
      result += i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", place, row[i])
                       : fmt::format("<td{}>{}</td>", place, row[i]);
    }
    result += "</tr>\n";
  }
  return result + "</tbody>\n</table>\n";
}

std::string bar_cell(double share, const std::string& text) {
  const double percent = std::isfinite(share) ? 100 * std::clamp(share, 0.0, 1.0) : 0;
  return fmt::format(
      "<span class=\"bar\"><span style=\"width:{:.1f}%\"></span></span>"
      "<span class=\"beside\">{}</span>",
      percent, escaped_markup(text));
}

}  // namespace vantage
