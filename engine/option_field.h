#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>

// An options struct is a template over its fields: `Options<std::type_identity_t>` is what is in
// force, `Options<OptionalField>` is what a user sets, with empty fields for the rest. Beside it
// stands visit_fields(visit, options...), the one list of its fields: it calls
// visit(description, options.field...) for each field, with one or several structs of the template.
// Everything that concerns all fields goes through that list.

namespace vantage {

/// Field of an options struct that a user may leave empty.
template <typename T>
using OptionalField = std::optional<T>;

/// The default of a field: `value` in a struct of what is in force, empty in one of overrides.
template <template <typename> class Field, typename T>
constexpr Field<T> by_default(T value) {
  if constexpr (std::same_as<Field<T>, T>) {
    return value;
  } else {
    return {};
  }
}

/// The values that a field accepts.
struct Limits {
  bool (*contain)(double value) = [](double) { return true; };
  std::string_view expected;  ///< in words, for messages: "an odd number from 1 to 181"
};

template <int min, int max>
constexpr bool is_within(double value) {
  return value >= min && value <= max;
}

/// Throws UsageError "OPTION is VALUE, expected …" for a value outside `limits`.
void require_within(const Limits& limits, std::string_view option, double value);

/// Throws UsageError for the first field of `options` with a value outside its limits.
template <typename Options>
void require_within_limits(const Options& options) {
  visit_fields(
      [](const auto& field, const auto& value) {
        require_within(field.limits, field.option, static_cast<double>(value));
      },
      options);
}

/// Gives `target`, which is of either kind, the fields that `overrides` have.
template <typename Overrides, typename Options>
void take_over(const Overrides& overrides, Options& target) {
  visit_fields(
      [](const auto& /*field*/, const auto& override_value, auto& value) {
        if (override_value) {
          value = *override_value;
        }
      },
      overrides, target);
}

/// Overrides with every field set, to what is in force.
template <typename Overrides, typename Options>
Overrides all_set(const Options& in_force) {
  Overrides result;
  visit_fields([](const auto& /*field*/, const auto& value, auto& field) { field = value; },
               in_force, result);
  return result;
}

/// Stands for the value of any field when fields are counted.
struct AnyFieldValue {
  template <typename T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};

/// Number of fields of an aggregate of numbers and enumerations.
template <typename Options, typename... Values>
consteval std::size_t count_fields() {
  if constexpr (requires { Options{Values{}..., AnyFieldValue{}}; }) {
    return count_fields<Options, Values..., AnyFieldValue>();
  } else {
    return sizeof...(Values);
  }
}

/// Whether visit_fields() calls its visitor once for each field: for static_assert, so that a field
/// that is forgotten there does not compile.
template <typename Options>
consteval bool visits_every_field() {
  std::size_t visited = 0;
  const Options options;
  visit_fields([&visited](const auto&...) { ++visited; }, options);
  return visited == count_fields<Options>();
}

}  // namespace vantage
