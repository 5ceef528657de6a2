#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "scheduler/range.h"

namespace vantage {

/// Writes the columns of a row from one of half the width: values[x] = half[x / 2]. columns: begins
/// at an even column.
template <typename T>
void repeat_columns(const T* half, scheduler::Range columns, T* values) {
  for (int x = columns.begin / 2; x < columns.end / 2; ++x) {
    // Compilers find vectors for pairs, but not for single values.
    const std::array<T, 2> pair = {half[x], half[x]};
    std::memcpy(values + std::ptrdiff_t{2} * x, pair.data(), sizeof(pair));
  }
  if (columns.end % 2 == 1) {
    values[columns.end - 1] = half[columns.end / 2];
  }
}

}  // namespace vantage
