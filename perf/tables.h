#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "perf/interleaved.h"

namespace vantage::perf {

/// Prints and returns a table of timings, each also divided by its work (cells, cells × iterations,
/// or `unit`) and by the first one.
inline nlohmann::json print_table(const std::string& title, const std::vector<Timing>& timings,
                                  const std::vector<double>& work,
                                  const std::string& unit = "cell") {
  fmt::print("\n{}\n{:<42} {:>9} {:>9} {:>9} {:>9} {:>7}\n", title, "", "min ms", "median ms",
             "max ms", "ns/" + unit, "ratio");
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < timings.size(); ++i) {
    const Timing& timing = timings[i];
    const double ratio = timing.median() / timings.front().median();
    fmt::print("{:<42} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.4f} {:>7.3f}\n", timing.name,
               timing.min() * 1e3, timing.median() * 1e3, timing.max() * 1e3,
               timing.median() / work[i] * 1e9, ratio);
    rows.push_back({{"name", timing.name},
                    {"min_seconds", timing.min()},
                    {"median_seconds", timing.median()},
                    {"max_seconds", timing.max()},
                    {"ns_per_" + unit, timing.median() / work[i] * 1e9},
                    {"ratio_to_first", ratio}});
  }
  return {{"title", title}, {"rows", rows}};
}

/// Same with equal work for all.
inline nlohmann::json print_table(const std::string& title, const std::vector<Timing>& timings,
                                  double work, const std::string& unit = "cell") {
  return print_table(title, timings, std::vector<double>(timings.size(), work), unit);
}

}  // namespace vantage::perf
