#include "apps/pages/figure_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "apps/book/figure_files.h"
#include "apps/pages/embedded_files.h"
#include "apps/pages/page_template.h"
#include "engine/build_info.h"
#include "engine/io/files/encoded_text.h"
#include "engine/options/parameter_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

/// Longer tables are files to save only.
constexpr std::size_t kMaxShownRows = 400;

std::string html_table(const FigureTable& table) {
  std::string html = "<table><thead><tr>";
  for (const std::string& column : table.columns) {
    html += fmt::format("<th>{}</th>", escaped_markup(column));
  }
  html += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) {
      html += fmt::format("<td>{}</td>", escaped_markup(cell));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string table_section(const BookFigure& figure, const FigureTable& table) {
  constexpr std::size_t kShortTable = 12;
  const std::string csv = csv_text(table);
  const std::string bytes =
      encode_base64(std::span(reinterpret_cast<const std::uint8_t*>(csv.data()), csv.size()));
  const std::string link =
      fmt::format("<a download=\"figure-{}{}{}.csv\" href=\"data:text/csv;base64,{}\">CSV</a>",
                  figure.key, table.name.empty() ? "" : "-", table.name, bytes);
  if (table.rows.size() > kMaxShownRows) {
    return fmt::format("<p>{} rows of numbers: {}</p>\n", table.rows.size(), link);
  }
  return fmt::format("<details{}><summary>{} rows of numbers</summary>\n<p>{}</p>\n{}</details>\n",
                     table.rows.size() <= kShortTable ? " open" : "", table.rows.size(), link,
                     html_table(table));
}

std::string figure_section(const MadeFigure& made) {
  const BookFigure& figure = *made.figure;
  std::string html = fmt::format(
      "<section id=\"figure-{0}\">\n<h2>{0} {1}</h2>\n<p class=\"soft\">Section {2}. "
      "In the book: {3}</p>\n",
      figure.key, escaped_markup(figure.title), figure.section, escaped_markup(figure.book));
  const auto add_line = [&html](const char* name, const std::string& text) {
    if (!text.empty()) {
      html += fmt::format("<p class=\"soft\">{}: {}</p>\n", name, escaped_markup(text));
    }
  };
  add_line("Images", made.content.images);
  add_line("Settings", describe_settings(figure, made.settings));
  if (!made.content.comparisons.empty()) {
    html += html_table(table_of(made.content.comparisons));
  }
  for (const FigurePicture& picture : made.content.pictures) {
    html += picture.drawing.svg();
  }
  for (const FigureTable& table : made.content.tables) {
    html += table_section(figure, table);
  }
  return html + "</section>\n";
}

}  // namespace

std::string describe_settings(const BookFigure& figure, const FigureSettings& in_force) {
  const FigureSettings settings = settings_read(figure, in_force);
  std::vector<std::string> parts;
  const auto add_list = [&parts](const char* name, const auto& list) {
    if (!list.empty()) {
      parts.push_back(fmt::format("{} {}", name, fmt::join(list, ", ")));
    }
  };
  if (settings.size_px) {
    parts.push_back(fmt::format("size {} pixels", *settings.size_px));
  }
  add_list("iterations", settings.iterations);
  if (settings.noise_sigmas == std::vector{kBookNoise}) {
    parts.emplace_back("noise as in the book (1 for ramp, else 0)");
  } else {
    add_list("noise", settings.noise_sigmas);
  }
  add_list("methods", settings.methods);
  add_list("pairs", settings.pairs);
  if (settings.seed) {
    parts.push_back(fmt::format("seed {}", *settings.seed));
  }
  Settings of_methods("book figure", "");
  MethodOverrides parameters = settings.parameters;
  add_shared_method_parameters(of_methods, parameters);
  const SettingValue values = of_methods.values();
  for (const auto& [name, value] : values.items()) {
    if (!is_word(value, "auto")) {
      parts.push_back(
          fmt::format("{} {}", name, value.is_string() ? to_text(value) : value.dump()));
    }
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string make_figure_page(const std::vector<MadeFigure>& figures, const std::string& command,
                             const std::string& machine) {
  std::string contents;
  std::string sections;
  for (const MadeFigure& made : figures) {
    contents += fmt::format("<li><a href=\"#figure-{0}\">{0}</a> {1}</li>\n", made.figure->key,
                            escaped_markup(made.figure->title));
    sections += figure_section(made);
  }
  return filled_in(embedded_file("figure_page/page.html"),
                   {{"version", build_info().version},
                    {"style", std::string(embedded_file("figure_page/page.css"))},
                    {"machine", escaped_markup(machine)},
                    {"command", escaped_markup(command)},
                    {"contents", contents},
                    {"figures", sections}});
}

}  // namespace vantage::apps
