#include "engine/figures/book_figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "engine/error.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/matching/options/method_fields.h"

namespace vantage {
namespace {

/// A field of FigureSettings but `parameters`, by its option.
template <typename Visit, typename... Settings>
void visit_settings(const Visit& visit, Settings&... settings) {
  visit("size", settings.size_px...);
  visit("iterations", settings.iterations...);
  visit("noise", settings.noise_sigmas...);
  visit("methods", settings.methods...);
  visit("pairs", settings.pairs...);
  visit("seed", settings.seed...);
}

template <typename T>
bool has_value(const std::optional<T>& field) {
  return field.has_value();
}
template <typename T>
bool has_value(const std::vector<T>& field) {
  return !field.empty();
}

/// The limits of the synthetic pairs hold for all figures.
void check_values(const FigureSettings& chosen) {
  ComparisonOptions options{
      .pairs = {"rds-square"}, .noise_sigmas = {0}, .methods = {"ssd"}, .parameters = {}};
  const auto take = [](const auto& field, auto& option) {
    if (!field.empty()) {
      option = field;
    }
  };
  take(chosen.pairs, options.pairs);
  take(chosen.noise_sigmas, options.noise_sigmas);
  take(chosen.methods, options.methods);
  take(chosen.iterations, options.iterations);
  options.size_px = chosen.size_px.value_or(options.size_px);
  options.validate();
}

std::vector<std::string> methods_of(const BookFigure& figure, const FigureSettings& in_force) {
  std::vector<std::string> methods = in_force.methods;
  if (!figure.method.empty()) {
    methods.emplace_back(figure.method);
  }
  return methods;
}

void check_parameters(const std::vector<const BookFigure*>& figures, const FigureSettings& chosen) {
  std::vector<MethodParameters> in_force;
  std::vector<std::string> names;
  for (const BookFigure* figure : figures) {
    for (const std::string& name : methods_of(*figure, settings_in_force(*figure, chosen))) {
      if (std::ranges::find(names, name) == names.end()) {
        MatchOptions options = compared_method(name).options(BookPattern::kRamp);
        take_over(chosen.parameters, options.parameters);
        in_force.push_back(options.resolved());
        names.push_back(name);
      }
    }
  }
  visit_fields(
      [&](const MethodField& field, const auto& value) {
        const bool is_read = std::ranges::any_of(
            in_force, [&field](const MethodParameters& method) { return field.is_read(method); });
        if (value && !is_read) {
          throw UsageError(fmt::format(
              "--{} has no effect: {}", field.option,
              names.empty()
                  ? "the figures match no images"
                  : fmt::format("none of the methods {} reads it", fmt::join(names, ", "))));
        }
      },
      chosen.parameters);
}

}  // namespace

FigureSettings settings_in_force(const BookFigure& figure, const FigureSettings& chosen) {
  FigureSettings settings = figure.defaults;
  visit_settings(
      [](const char* /*option*/, const auto& wanted, auto& field) {
        if (has_value(field) && has_value(wanted)) {
          field = wanted;
        }
      },
      chosen, settings);
  take_over(chosen.parameters, settings.parameters);
  return settings;
}

void check_settings(const std::vector<const BookFigure*>& figures, const FigureSettings& chosen) {
  check_values(chosen);
  FigureSettings read;
  for (const BookFigure* figure : figures) {
    visit_settings(
        [](const char* /*option*/, const auto& field, auto& any) {
          if (has_value(field)) {
            any = field;
          }
        },
        figure->defaults, read);
  }
  visit_settings(
      [](const char* option, const auto& wanted, const auto& any) {
        if (has_value(wanted) && !has_value(any)) {
          throw UsageError(fmt::format("--{} has no effect on these figures", option));
        }
      },
      chosen, read);
  check_parameters(figures, chosen);
}

}  // namespace vantage
