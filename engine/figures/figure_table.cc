#include "engine/figures/figure_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>

#include "engine/error.h"
#include "engine/figures/figure_families.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr auto kFamilies = {
    view_figures,       formula_figures,       response_figures,        gradient_figures,
    pattern_figures,    pair_map_figures,      disparity_space_figures, membrane_figures,
    comparison_figures, several_images_figures};

/// "6.16" after "6.9".
struct FigureOrder {
  explicit FigureOrder(std::string_view key) {
    const char* const end = key.data() + key.size();
    const auto after = std::from_chars(key.data(), end, chapter).ptr;
    if (after != end) {
      std::from_chars(after + 1, end, number);
    }
  }
  friend auto operator<=>(const FigureOrder&, const FigureOrder&) = default;

  int chapter = 0;
  int number = 0;
};

std::vector<BookFigure> all_figures() {
  std::vector<BookFigure> all;
  for (const auto family : kFamilies) {
    std::ranges::move(family(), std::back_inserter(all));
  }
  std::ranges::stable_sort(all, {},
                           [](const BookFigure& figure) { return FigureOrder(figure.key); });
  return all;
}

}  // namespace

std::span<const BookFigure> book_figures() {
  static const std::vector<BookFigure> figures = all_figures();
  return figures;
}

std::vector<const BookFigure*> figures_named(std::string_view name) {
  std::vector<const BookFigure*> figures;
  std::vector<std::string_view> keys;
  for (const BookFigure& figure : book_figures()) {
    keys.push_back(figure.key);
    if (name == "all" || name == figure.key || name == figure.key.substr(0, figure.key.find('.'))) {
      figures.push_back(&figure);
    }
  }
  if (figures.empty()) {
    throw UsageError(fmt::format("figure '{}' is unknown, expected all, a chapter or one of {}",
                                 quotable(name), fmt::join(keys, ", ")));
  }
  return figures;
}

}  // namespace vantage
