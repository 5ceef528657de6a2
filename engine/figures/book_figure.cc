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

/// The parameters of each method in force.
std::vector<MethodParameters> parameters_of(const BookFigure& figure,
                                            const FigureSettings& in_force) {
  std::vector<MethodParameters> all;
  for (const std::string& name : methods_of(figure, in_force)) {
    MatchOptions options = compared_method(name).options(BookPattern::kRamp);
    take_over(in_force.parameters, options.parameters);
    all.push_back(options.resolved());
  }
  return all;
}

bool reads(const BookFigure& figure, const std::vector<MethodParameters>& parameters,
           const MethodField& field) {
  const bool is_of_figure =
      figure.parameters.empty() ||
      std::ranges::find(figure.parameters, field.option) != figure.parameters.end();
  return is_of_figure && std::ranges::any_of(parameters, [&field](const MethodParameters& method) {
           return field.is_read(method);
         });
}

/// Throws UsageError for the first parameter of `chosen` that is not in `read`.
void check_parameters(const std::vector<const BookFigure*>& figures, const FigureSettings& chosen,
                      const MethodOverrides& read) {
  std::vector<std::string> names;
  for (const BookFigure* figure : figures) {
    for (const std::string& name : methods_of(*figure, settings_in_force(*figure, chosen))) {
      if (std::ranges::find(names, name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  visit_fields(
      [&names](const MethodField& field, const auto& wanted, const auto& any) {
        if (wanted && !any) {
          throw UsageError(
              fmt::format("--{} has no effect: {}", field.option,
                          names.empty() ? "the figures match no images"
                                        : fmt::format("the figures do not read it, with methods {}",
                                                      fmt::join(names, ", "))));
        }
      },
      chosen.parameters, read);
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

FigureSettings settings_read(const BookFigure& figure, const FigureSettings& in_force) {
  FigureSettings read = in_force;
  const auto methods = methods_of(figure, in_force);
  if (std::ranges::none_of(
          methods, [](const std::string& name) { return compared_method(name).is_iterative; })) {
    read.iterations.clear();
  }
  const auto parameters = parameters_of(figure, in_force);
  visit_fields(
      [&](const MethodField& field, auto& value) {
        if (!reads(figure, parameters, field)) {
          value.reset();
        }
      },
      read.parameters);
  return read;
}

void check_settings(const std::vector<const BookFigure*>& figures, const FigureSettings& chosen) {
  check_values(chosen);
  FigureSettings read;
  for (const BookFigure* figure : figures) {
    const FigureSettings of_figure = settings_read(*figure, settings_in_force(*figure, chosen));
    visit_settings(
        [](const char* /*option*/, const auto& field, auto& any) {
          if (has_value(field)) {
            any = field;
          }
        },
        of_figure, read);
    take_over(of_figure.parameters, read.parameters);
  }
  visit_settings(
      [](const char* option, const auto& wanted, const auto& any) {
        if (has_value(wanted) && !has_value(any)) {
          throw UsageError(fmt::format("--{} has no effect on these figures", option));
        }
      },
      chosen, read);
  check_parameters(figures, chosen, read.parameters);
}

}  // namespace vantage
