#pragma once

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// A noise: that of the book's text, which depends on the pair (pair_runs.h).
inline constexpr double kBookNoise = -1;

/// What can be chosen for a figure. In a figure's defaults a field without a value is one that the
/// figure does not read; in a user's choice it is one that keeps its default.
struct FigureSettings {
  std::optional<int> size_px = std::nullopt;  ///< width and height of the book's synthetic pairs
  std::vector<int> iterations = {};
  std::vector<double> noise_sigmas = {};             ///< grey levels
  std::vector<std::string> methods = {};             ///< names of compared_methods()
  std::vector<std::string> pairs = {};               ///< names of kBookPairNames
  std::optional<std::uint64_t> seed = std::nullopt;  ///< of what is generated
  MethodOverrides parameters = {};                   ///< each is used by the methods that read it
};

/// Numbers of a figure: a CSV file, and a table of the report.
struct FigureTable {
  /// A row of texts and numbers; numbers with a precision are texts.
  template <typename... Cells>
  void add(const Cells&... cells) {
    rows.push_back({fmt::format("{}", cells)...});
  }

  std::string name;  ///< in file names; empty: the figure's main table
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};
};

struct FigurePicture {
  std::string name;  ///< in file names; empty: the figure's only picture
  Drawing drawing;
};

/// A statement or number of the book and what came out here.
struct BookComparison {
  std::string what;
  std::string book;
  std::string ours;
};

/// A figure as it comes out here.
struct FigureContent {
  std::vector<FigurePicture> pictures = {};
  std::vector<FigureTable> tables = {};
  std::vector<BookComparison> comparisons = {};
  std::string images = {};  ///< which images were used, and why
};

/// Photographs of the book. None of them is public (figure_images.h).
enum class BookImages {
  kNone,
  kKids,             ///< Figs. 1.1, 3.4 to 3.6, 5.12
  kBirch,            ///< Figs. 3.7 to 3.9
  kStreet,           ///< Figs. 5.3 to 5.6: cameras not rectified, of other brightness
  kRectifiedStreet,  ///< Fig. 5.9
  kTree,             ///< Figs. 5.7, 5.8, 6.18
  kCat,              ///< Figs. 5.10, 5.11: two times, moving camera and scene
  kTown,             ///< Fig. 6.19: cameras above each other
};
struct FigureImages;

/// One computation of a figure.
struct FigureRun {
  const FigureSettings& settings;  ///< in force: every field that the figure reads has a value
  Execution& execution;
  const std::atomic<bool>* stop = nullptr;  ///< set: the result will not be used
  const FigureImages* given = nullptr;      ///< in place of the book's images; null: stand-ins
};

/// A figure of the book.
struct BookFigure {
  std::string_view key;      ///< its number in the book, "6.16"
  std::string_view section;  ///< of the book
  std::string_view title;
  std::string_view book;  ///< what the book shows and prints
  FigureSettings defaults;
  /// Method whose parameters the figure reads although it reads no methods; empty: none.
  std::string_view method = {};
  /// Options of the only parameters of `method` that the figure reads; empty: all that it reads.
  std::vector<std::string_view> parameters = {};
  BookImages images = BookImages::kNone;  ///< which the figure is about
  std::function<FigureContent(const FigureRun& run)> make = {};
};

/// The settings in force: those of `chosen` that the figure reads, else its defaults.
FigureSettings settings_in_force(const BookFigure& figure, const FigureSettings& chosen);

/// What a figure reads of its settings in force: iterations only where a method in force is
/// iterative, and the parameters of these methods.
FigureSettings settings_read(const BookFigure& figure, const FigureSettings& in_force);

/// Throws UsageError for values out of range, and for the first setting of `chosen` that none of
/// `figures` reads.
void check_settings(const std::vector<const BookFigure*>& figures, const FigureSettings& chosen);

}  // namespace vantage
