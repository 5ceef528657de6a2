#include "apps/book/figure_files.h"

#include <fmt/format.h>

#include "engine/io/files/atomic_file.h"

namespace vantage::apps {
namespace {

std::string quoted_field(const std::string& field) {
  if (field.find_first_of(",\"\n") == std::string::npos) {
    return field;
  }
  std::string quoted = "\"";
  for (const char letter : field) {
    quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return quoted + '"';
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    line += (line.empty() ? "" : ",") + quoted_field(field);
  }
  return line + '\n';
}

std::string file_name(const BookFigure& figure, const std::string& name, std::string_view ending) {
  return fmt::format("figure-{}{}{}{}", figure.key, name.empty() ? "" : "-", name, ending);
}

}  // namespace

FigureTable table_of(const std::vector<BookComparison>& comparisons) {
  FigureTable table{"book", {"what", "book", "here"}, {}};
  for (const BookComparison& comparison : comparisons) {
    table.rows.push_back({comparison.what, comparison.book, comparison.ours});
  }
  return table;
}

std::string csv_text(const FigureTable& table) {
  std::string text = csv_line(table.columns);
  for (const std::vector<std::string>& row : table.rows) {
    text += csv_line(row);
  }
  return text;
}

std::vector<std::string> write_figure(const std::filesystem::path& folder, const BookFigure& figure,
                                      const FigureContent& content) {
  std::vector<std::string> names;
  for (const FigurePicture& picture : content.pictures) {
    names.push_back(file_name(figure, picture.name, ".svg"));
    write_text_file(folder / names.back(),
                    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + picture.drawing.svg());
  }
  const auto write_table = [&](const FigureTable& table) {
    names.push_back(file_name(figure, table.name, ".csv"));
    write_text_file(folder / names.back(), csv_text(table));
  };
  for (const FigureTable& table : content.tables) {
    write_table(table);
  }
  if (!content.comparisons.empty()) {
    write_table(table_of(content.comparisons));
  }
  return names;
}

}  // namespace vantage::apps
