#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/figures/book_figure.h"

namespace vantage::apps {

/// Writes figure-KEY-NAME.svg for each picture, figure-KEY-NAME.csv for each table and
/// figure-KEY-book.csv for the comparisons to `folder`, which exists. Returns the names of the
/// files. Throws Error.
std::vector<std::string> write_figure(const std::filesystem::path& folder, const BookFigure& figure,
                                      const FigureContent& content);

/// The comparisons as a table.
FigureTable table_of(const std::vector<BookComparison>& comparisons);
/// Comma-separated values, with the names of the columns first.
std::string csv_text(const FigureTable& table);

}  // namespace vantage::apps
