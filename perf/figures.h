#pragma once

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perf/stopwatch.h"

namespace vantage::perf {

/// "1.97 (1.80-2.10)": median and range; `digits` applies to the median.
inline std::string with_range(const std::vector<double>& values, int digits = 2) {
  return fmt::format("{:.{}f} ({:.2f}-{:.2f})", median(values), digits, min(values), max(values));
}

/// Same for --json.
inline nlohmann::json figures(const std::vector<double>& values) {
  return {{"median", median(values)}, {"least", min(values)}, {"most", max(values)}};
}

/// Writes the file of --json, if it was given.
inline void write_json(const std::optional<std::string>& path, const nlohmann::json& tables) {
  if (path) {
    std::ofstream(*path) << tables.dump(2) << '\n';
  }
}

}  // namespace vantage::perf
