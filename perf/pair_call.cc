// Time of one call of PairMatcher::match() for the left map and its mask: what perf/python_speed
// compares Matcher.compute() with. Usage: pair_call LEFT RIGHT PRESET MIN MAX CALLS; prints the
// milliseconds of each call in one line.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

#include "engine/matching/options/method_names.h"
#include "engine/vantage.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 7) {
    std::fputs("usage: pair_call LEFT RIGHT PRESET MIN MAX CALLS\n", stderr);
    return 2;
  }
  const vantage::Photograph left = vantage::read_photograph(arguments[1]);
  const vantage::Photograph right = vantage::read_photograph(arguments[2]);
  vantage::MatchOptions options;
  const auto& names = vantage::preset_names();
  options.preset = std::ranges::find(names, std::string_view(arguments[3]), [](const auto& entry) {
                     return entry.first;
                   })->second;
  options.disparities = {std::stoi(arguments[4]), std::stoi(arguments[5])};
  const vantage::PairMatcher matcher(options);
  vantage::DisparityMaps maps;
  for (int call = 0; call < std::stoi(arguments[6]); ++call) {
    const auto start = std::chrono::steady_clock::now();
    matcher.match(left, right, {.right = false}, maps);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    fmt::print("{:.4f} ", time.count());
  }
  fmt::print("\n");
}
