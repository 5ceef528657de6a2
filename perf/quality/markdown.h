#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace vantage::perf {

/// Prints the first two lines of a table whose first column has no title.
inline void print_header(const std::vector<std::string>& titles) {
  fmt::print("| |");
  for (const std::string& title : titles) {
    fmt::print(" {} |", title);
  }
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < titles.size(); ++i) {
    fmt::print("---|");
  }
  fmt::print("\n");
}

/// Formats a cell; a dash if the value is not finite.
inline std::string cell(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

}  // namespace vantage::perf
