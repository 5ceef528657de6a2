#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <ranges>

namespace vantage {

// Of values (at least one, none NaN), which are reordered: pass a copy where the order matters.
// Thread rule: pure.

/// The value at place `rank`, from 0, of the sorted values.
template <std::ranges::random_access_range Values>
[[nodiscard]] auto value_of_rank(Values&& values, std::size_t rank) {
  const auto place = std::ranges::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(values, place);
  return *place;
}

/// The value with the rank nearest to the fraction `share`, 0 to 1, of the sorted values.
template <std::ranges::random_access_range Values>
[[nodiscard]] auto percentile(Values&& values, double share) {
  const auto last = static_cast<double>(std::ranges::size(values) - 1);
  return value_of_rank(values, static_cast<std::size_t>(std::lround(share * last)));
}

/// The median; for even sizes the upper middle value.
template <std::ranges::random_access_range Values>
[[nodiscard]] auto upper_median(Values&& values) {
  return value_of_rank(values, std::ranges::size(values) / 2);
}

}  // namespace vantage
