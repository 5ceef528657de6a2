// Time of one call of PairMatcher::match() for the left map and its mask: what perf/python_speed
// compares Matcher.compute() with. Prints the milliseconds of each call in one line.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "engine/matching/options/method_names.h"
#include "engine/vantage.h"
#include "perf/command_line.h"

int main(int argc, char** argv) {
  std::string left_file;
  std::string right_file;
  std::string preset = "balanced";
  vantage::DisparityRange disparities = {0, 63};
  int calls = 1;
  vantage::perf::CommandLine line("Time of calls of PairMatcher::match() for the left map");
  line.option("LEFT", left_file, "Left photograph");
  line.option("RIGHT", right_file, "Right photograph");
  line.option("--preset", preset, "Preset");
  line.option("--min", disparities.min, "Min disparity");
  line.option("--max", disparities.max, "Max disparity");
  line.number("--calls", calls, "Calls");
  line.parse(argc, argv);
  vantage::MatchOptions options;
  const auto& names = vantage::names_of(vantage::MatchPreset{});
  const auto found = std::ranges::find(names, std::string_view(preset),
                                       [](const auto& entry) { return entry.first; });
  if (found == names.end()) {
    line.refuse(fmt::format("--preset is '{}', expected a preset", preset));
  }
  options.preset = found->second;
  options.disparities = disparities;
  const vantage::Photograph left = vantage::read_photograph(left_file);
  const vantage::Photograph right = vantage::read_photograph(right_file);
  const vantage::PairMatcher matcher(options);
  vantage::DisparityMaps maps;
  for (int call = 0; call < calls; ++call) {
    const auto start = std::chrono::steady_clock::now();
    matcher.match(left, right, {.right = false}, maps);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    fmt::print("{:.4f} ", time.count());
  }
  fmt::print("\n");
}
