#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

// Samples for tests that repeat over many ways to do the same: executors, strips, bands, passes.
// A row chooses one value of each dimension, by index. Few rows are enough for every pair of values
// of two dimensions to meet in one of them, and a fault that needs more than two values to come
// together is rare. The sample is always the same, so that a failure can be repeated, unless
// VANTAGE_TEST_SEED draws another one. With VANTAGE_TEST_ALL (not empty, not 0) all rows are run.

namespace vantage {
inline namespace test {

inline bool runs_everything() {
  const char* const all = std::getenv("VANTAGE_TEST_ALL");
  return all != nullptr && std::string(all) != "" && std::string(all) != "0";
}

inline std::uint32_t sample_seed() {
  const char* const seed = std::getenv("VANTAGE_TEST_SEED");
  return seed == nullptr ? 1 : static_cast<std::uint32_t>(std::strtoul(seed, nullptr, 10));
}

/// For messages: what draws the same rows again.
inline std::string sample_name() {
  return runs_everything() ? "VANTAGE_TEST_ALL=1"
                           : "VANTAGE_TEST_SEED=" + std::to_string(sample_seed());
}

using SampleRow = std::vector<int>;
/// Whether a row is to be had; without one all are.
using RowFilter = std::function<bool(const SampleRow&)>;

/// All rows of dimensions with `sizes` values.
inline std::vector<SampleRow> all_rows(const std::vector<int>& sizes,
                                       const RowFilter& is_allowed = {}) {
  std::vector<SampleRow> rows;
  for (SampleRow row(sizes.size(), 0);;) {
    if (!is_allowed || is_allowed(row)) {
      rows.push_back(row);
    }
    std::size_t k = sizes.size();
    while (k > 0 && ++row[k - 1] == sizes[k - 1]) {
      row[--k] = 0;
    }
    if (k == 0) {
      return rows;
    }
  }
}

/// Rows in which every pair of values of two dimensions occurs that any allowed row has; rare pairs
/// are looked for by chance, so is_allowed should not refuse more than most rows.
inline std::vector<SampleRow> covering_rows(const std::vector<int>& sizes, std::uint32_t seed,
                                            const RowFilter& is_allowed = {}) {
  std::mt19937 random(seed);  // its numbers are the same everywhere, those of distributions are not
  const std::size_t dimensions = sizes.size();
  // Values of all dimensions are counted through; wanted[a][b] for values of two dimensions, a < b.
  std::vector<int> offset(dimensions + 1, 0);
  for (std::size_t k = 0; k < dimensions; ++k) {
    offset[k + 1] = offset[k] + sizes[k];
  }
  const auto values = static_cast<std::size_t>(offset[dimensions]);
  std::vector<std::vector<char>> wanted(values, std::vector<char>(values, 0));
  const auto pair_of = [&](const SampleRow& row, std::size_t j, std::size_t k) -> char& {
    return wanted[static_cast<std::size_t>(offset[j] + row[j])]
                 [static_cast<std::size_t>(offset[k] + row[k])];
  };
  const auto for_each_pair = [&](const SampleRow& row, const auto& visit) {
    for (std::size_t j = 0; j < dimensions; ++j) {
      for (std::size_t k = j + 1; k < dimensions; ++k) {
        visit(pair_of(row, j, k));
      }
    }
  };
  std::vector<SampleRow> rows;
  const auto take = [&](const SampleRow& row) {
    for_each_pair(row, [](char& pair) { pair = 0; });
    rows.push_back(row);
  };
  /// The best of some rows by chance that have `fixed` where that is not −1; empty if none is
  /// allowed.
  const auto best_row = [&](const SampleRow& fixed) {
    SampleRow best;
    int max = -1;
    for (int trial = 0, found = 0; trial < 300 && found < 30; ++trial) {
      SampleRow row = fixed;
      for (std::size_t k = 0; k < dimensions; ++k) {
        if (row[k] < 0) {
          row[k] = static_cast<int>(random() % static_cast<unsigned>(sizes[k]));
        }
      }
      if (is_allowed && !is_allowed(row)) {
        continue;
      }
      ++found;
      int gain = 0;
      for_each_pair(row, [&](char pair) { gain += pair; });
      if (gain > max) {
        max = gain;
        best = std::move(row);
      }
    }
    return best;
  };
  if (dimensions == 1) {
    return all_rows(sizes, is_allowed);
  }
  std::vector<SampleRow> pairs;  // the two values, −1 elsewhere
  for (std::size_t j = 0; j < dimensions; ++j) {
    for (std::size_t k = j + 1; k < dimensions; ++k) {
      for (int a = 0; a < sizes[j]; ++a) {
        for (int b = 0; b < sizes[k]; ++b) {
          SampleRow pair(dimensions, -1);
          pair[j] = a;
          pair[k] = b;
          pair_of(pair, j, k) = 1;
          pairs.push_back(std::move(pair));
        }
      }
    }
  }
  for (std::size_t i = pairs.size(); i > 1; --i) {
    std::swap(pairs[i - 1], pairs[random() % i]);
  }
  for (const SampleRow& pair : pairs) {
    bool is_wanted = false;
    for (std::size_t j = 0; j < dimensions; ++j) {
      for (std::size_t k = j + 1; k < dimensions; ++k) {
        is_wanted = is_wanted || (pair[j] >= 0 && pair[k] >= 0 && pair_of(pair, j, k) != 0);
      }
    }
    if (!is_wanted) {
      continue;
    }
    const SampleRow row = best_row(pair);
    if (!row.empty()) {
      take(row);
    }
  }
  return rows;
}

/// What a test is to run: a covering sample by the seed, or everything.
inline std::vector<SampleRow> sampled_rows(const std::vector<int>& sizes,
                                           const RowFilter& is_allowed = {}) {
  return runs_everything() ? all_rows(sizes, is_allowed)
                           : covering_rows(sizes, sample_seed(), is_allowed);
}

/// The rows whose first dimension, the instances of a test with parameters, has `value`.
inline std::vector<SampleRow> rows_of(const std::vector<SampleRow>& rows, int value) {
  std::vector<SampleRow> result;
  std::ranges::copy_if(rows, std::back_inserter(result),
                       [value](const SampleRow& row) { return row.front() == value; });
  return result;
}

}  // namespace test
}  // namespace vantage
