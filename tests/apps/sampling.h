#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

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
    chosen.push_back(cases[static_cast<std::size_t>(i)]);
  }
  return chosen;
}

/// One of the cases of each group, in the order of the first ones. `group_of` names a case's group,
/// such as the option it is about.
template <typename Case, typename GroupOf>
std::vector<Case> sampled_of_each(const std::vector<Case>& cases, const GroupOf& group_of,
                                  std::uint32_t stream) {
  if (test::runs_everything()) {
    return cases;
  }
  std::vector<std::pair<std::string, std::vector<Case>>> groups;
  for (const Case& one : cases) {
    const std::string name = group_of(one);
    auto group =
        std::ranges::find_if(groups, [&](const auto& other) { return other.first == name; });
    if (group == groups.end()) {
      group = groups.insert(groups.end(), {name, {}});
    }
    group->second.push_back(one);
  }
  std::vector<Case> chosen;
  SampledNumbers numbers(stream);
  for (const auto& [name, members] : groups) {
    chosen.push_back(members[numbers.below(members.size())]);
  }
  return chosen;
}

/// The option that a command line is about: the last one, without a value joined to it.
inline std::string last_option(const std::vector<std::string>& arguments) {
  for (std::size_t i = arguments.size(); i-- > 0;) {
    const std::string& text = arguments[i];
    if (text.size() > 1 && text[0] == '-' && (text[1] < '0' || text[1] > '9')) {
      return text.substr(0, text.find('='));
    }
  }
  return {};
}

/// Command lines that are refused, each for its last option: all of them, as every bound is checked
/// by code of its own; under a sanitizer, where each process takes long to begin, those of some
/// options, one each.
template <typename Case, typename ArgumentsOf>
std::vector<Case> sampled_command_lines(const std::vector<Case>& cases,
                                        const ArgumentsOf& arguments_of) {
  if (!test_paths::is_sanitized()) {
    return cases;
  }
  const auto stream = static_cast<std::uint32_t>(cases.size());
  return sampled(
      sampled_of_each(
          cases, [&](const Case& one) { return last_option(arguments_of(one)); }, stream),
      10, stream);
}

}  // namespace vantage
