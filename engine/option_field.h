#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>

// An options struct is a template over its fields: `Options<std::type_identity_t>` holds the values
// in force, `Options<OptionalField>` what a user sets, with empty fields for the rest.
// visit_fields(visit, options...), declared next to it, is the only list of its fields: it calls
// visit(description, options.field...) for each field, with one or several structs of the template.
// Everything that concerns all fields goes through that list.

namespace vantage {

/// Field of an options struct that may be left empty.
template <typename T>
using OptionalField = std::optional<T>;

/// Default of a field: `value` in a struct of values in force, empty in one of overrides.
template <template <typename> class Field, typename T>
constexpr Field<T> by_default(T value) {
  if constexpr (std::same_as<Field<T>, T>) {
    return value;
  } else {
    return {};
  }
}

/// Values that a field accepts.
struct Limits {
  bool (*contain)(double value) = [](double) { return true; };
  std::string_view expected;  ///< for messages: "an odd number from 1 to 181"
};

template <int min, int max>
constexpr bool is_within(double value) {
  return value >= min && value <= max;
}

/// Throws UsageError "OPTION is VALUE, expected …" for a value outside `limits`.
void require_within(const Limits& limits, std::string_view option, double value);

/// Throws UsageError for the first field of `options` outside its limits.
template <typename Options>
void require_within_limits(const Options& options) {
  visit_fields(
      [](const auto& field, const auto& value) {
        require_within(field.limits, field.option, static_cast<double>(value));
      },
      options);
}

/// Copies the fields set in `overrides` to `target`, which may be of either kind.
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

/// Overrides with every field set to the value in force.
template <typename Overrides, typename Options>
Overrides all_set(const Options& in_force) {
  Overrides result;
  visit_fields([](const auto& /*field*/, const auto& value, auto& field) { field = value; },
               in_force, result);
  return result;
}

/// Placeholder for the value of any field when fields are counted.
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

/// Whether visit_fields() calls its visitor once for each field. For static_assert, so that code
/// with a field missing there does not compile.
template <typename Options>
consteval bool visits_every_field() {
  std::size_t visited = 0;
  const Options options;
  visit_fields([&visited](const auto&...) { ++visited; }, options);
  return visited == count_fields<Options>();
}

}  // namespace vantage
