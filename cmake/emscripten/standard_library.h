// What the engine uses of C++20's standard library and Emscripten's, of LLVM 13, is without: in
// every file first. Algorithms of ranges take and return what the standard says, in the forms in
// use.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <ranges>
#include <string>
#include <type_traits>

namespace std {

template <typename To, typename From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
         is_trivially_copyable_v<From>) constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// Numbers as strtod() takes them, but for white space, a plus sign, hexadecimals.
template <typename Number>
requires is_floating_point_v<Number> from_chars_result from_chars(const char* first,
                                                                  const char* last, Number& value) {
  const string text(first, last);
  const size_t digits = text.find_first_not_of('-');
  const bool is_number = digits <= 1 && text.find_first_of("xX") == string::npos &&
                         (isalnum(static_cast<unsigned char>(text[digits])) || text[digits] == '.');
  char* end = nullptr;
  const double number = is_number ? strtod(text.c_str(), &end) : 0;
  if (end == nullptr || end == text.c_str()) {
    return {first, errc::invalid_argument};
  }
  value = static_cast<Number>(number);
  return {first + (end - text.c_str()), errc{}};
}

namespace ranges {

template <typename Range, typename Predicate, typename Projection = identity>
constexpr auto find_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& element) {
    return invoke(predicate, invoke(projection, element));
  });
}

template <typename Range, typename Value, typename Projection = identity>
constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
  return ranges::find_if(
      range, [&](const auto& element) { return element == value; }, projection);
}

template <typename Range, typename Predicate>
constexpr bool any_of(Range&& range, Predicate predicate) {
  return std::any_of(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Predicate>
constexpr bool all_of(Range&& range, Predicate predicate) {
  return std::all_of(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Predicate>
constexpr bool none_of(Range&& range, Predicate predicate) {
  return std::none_of(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Other>
constexpr bool equal(Range&& range, Other&& other) {
  return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other));
}

template <typename Compare, typename Projection>
auto projected_order(Compare& compare, Projection& projection) {
  return [&](const auto& a, const auto& b) {
    return invoke(compare, invoke(projection, a), invoke(projection, b));
  };
}

template <typename Range, typename Compare = std::less<>, typename Projection = identity>
auto min_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::min_element(std::begin(range), std::end(range), projected_order(compare, projection));
}

template <typename Range, typename Compare = std::less<>, typename Projection = identity>
auto max_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::max_element(std::begin(range), std::end(range), projected_order(compare, projection));
}

template <typename Range>
auto min(Range&& range) {
  return *ranges::min_element(range);
}

template <typename Range>
auto max(Range&& range) {
  return *ranges::max_element(range);
}

template <typename Range, typename Compare = std::less<>, typename Projection = identity>
void stable_sort(Range&& range, Compare compare = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), projected_order(compare, projection));
}

template <typename Range, typename Value, typename Compare = std::less<>,
          typename Projection = identity>
auto upper_bound(Range&& range, const Value& value, Compare compare = {},
                 Projection projection = {}) {
  return std::upper_bound(std::begin(range), std::end(range), value,
                          [&](const Value& one, const auto& element) {
                            return invoke(compare, one, invoke(projection, element));
                          });
}

template <typename Range, typename Iterator>
void nth_element(Range&& range, Iterator place) {
  std::nth_element(std::begin(range), place, std::end(range));
}

template <typename Range, typename Output, typename Operation>
void transform(Range&& range, Output output, Operation operation) {
  std::transform(std::begin(range), std::end(range), output,
                 [&](auto&& element) { return invoke(operation, element); });
}

template <typename Range, typename Value>
void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <typename Range, typename Output, typename Predicate>
void copy_if(Range&& range, Output output, Predicate predicate) {
  std::copy_if(std::begin(range), std::end(range), output, predicate);
}

template <typename Range>
void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}

template <typename Range, typename Value>
auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}

template <typename Range, typename Output>
void move(Range&& range, Output output) {
  std::move(std::begin(range), std::end(range), output);
}

}  // namespace ranges
}  // namespace std
