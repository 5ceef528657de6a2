#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace vantage::perf {

/// One candidate of a comparison.
struct Contender {
  std::string name;
  std::function<void()> run;
};

/// Seconds per round of one contender.
struct Timing {
  std::string name;
  std::vector<double> seconds;   ///< sorted
  std::vector<double> by_round;  ///< in order of measurement

  [[nodiscard]] double min() const { return seconds.front(); }
  [[nodiscard]] double median() const { return seconds[seconds.size() / 2]; }
  [[nodiscard]] double max() const { return seconds.back(); }
};

/// Runs all contenders in turn, `rounds` times after one warm-up round, so that changes of the
/// machine's speed affect all of them.
inline std::vector<Timing> time_interleaved(const std::vector<Contender>& contenders, int rounds) {
  std::vector<Timing> timings;
  for (const Contender& contender : contenders) {
    timings.push_back({contender.name, {}, {}});
    contender.run();
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      contenders[i].run();
      const auto end = std::chrono::steady_clock::now();
      timings[i].seconds.push_back(std::chrono::duration<double>(end - begin).count());
    }
  }
  for (Timing& timing : timings) {
    timing.by_round = timing.seconds;
    std::sort(timing.seconds.begin(), timing.seconds.end());
  }
  return timings;
}

}  // namespace vantage::perf
