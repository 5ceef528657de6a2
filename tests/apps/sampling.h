#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <set>

#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"
#include "tests/test_sample.h"

/// Tests that could go through very many cases take a sample; tests/test_sample.h says which.
namespace vantage {

/// Whole numbers from the seed, the same with every standard library. `stream` tells tests apart.
class SampledNumbers {
 public:
  explicit SampledNumbers(std::uint32_t stream)
      : generator_(test::sample_seed() * 2654435761U + stream) {}
  /// From 0 to `count` - 1.
  std::size_t below(std::size_t count) { return generator_() % count; }
  /// From 0 to below 1.
  double share() { return static_cast<double>(generator_()) / 4294967296.0; }

 private:
  std::mt19937 generator_;
};

/// `always`, first, last and `count` others of first … last, in order; all of them when everything
/// is tested. What of `always` lies outside of the range is left out.
inline std::vector<int> sampled_range(int first, int last, int count, std::uint32_t stream,
                                      const std::vector<int>& always = {}) {
  std::set<int> chosen = {first, last};
  for (const int number : always) {
    if (number >= first && number <= last) {
      chosen.insert(number);
    }
  }
  const auto all = static_cast<std::size_t>(last - first + 1);
  const std::size_t wanted = test::runs_everything()
                                 ? all
                                 : std::min(all, chosen.size() + static_cast<std::size_t>(count));
  if (wanted == all) {
    for (int number = first; number <= last; ++number) {
      chosen.insert(number);
    }
  }
  for (SampledNumbers numbers(stream); chosen.size() < wanted;) {
    chosen.insert(first + static_cast<int>(numbers.below(all)));
  }
  return {chosen.begin(), chosen.end()};
}

/// First, last and `count` others of `cases`, in order.
template <typename Case>
std::vector<Case> sampled(const std::vector<Case>& cases, int count, std::uint32_t stream) {
  std::vector<Case> chosen;
  for (const int i : sampled_range(0, static_cast<int>(cases.size()) - 1, count, stream)) {
    chosen.push_back(cases[i]);
  }
  return chosen;
}

/// What a command refuses: the words that follow it, and what its one line says.
struct Refusal {
  Words words;
  std::string says;
  int exit_code = 2;
};

/// Each of them is refused in one line and leaves `folder` as it was; `run` starts the command with
/// the words. Under a sanitizer, where each process takes long to begin, a sample of them.
template <typename Run>
void expect_refusals(const std::string& command, const fs::path& folder,
                     const std::vector<Refusal>& refusals, const Run& run,
                     std::source_location where = std::source_location::current()) {
  SCOPED_TRACE(test::sample_name());
  const Words before = files_below(folder);
  const auto stream = static_cast<std::uint32_t>(refusals.size());
  for (const Refusal& refusal :
       test_paths::is_sanitized() ? sampled(refusals, 10, stream) : refusals) {
    expect_one_line(run(refusal.words), refusal.exit_code, command, refusal.says, where);
  }
  EXPECT_EQ(files_below(folder), before);
}

}  // namespace vantage
