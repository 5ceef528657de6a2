#include "engine/sequence/pairs/frame_numbering.h"

#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace vantage {
namespace {

/// Missing numbers between two frames.
struct Gap {
  long long first = 0;
  long long last = 0;
  long long missing = 0;

  friend auto operator<=>(const Gap&, const Gap&) = default;
};

struct Numbering {
  std::vector<long long> numbers;  ///< of each frame; empty if one has none
  long long increment = 0;         ///< from frame to frame; 0: they do not increase evenly
};

/// The difference of successive numbers if at least half of them have it and all others are
/// multiples of it (none negative), else 0.
long long usual_increment(const std::vector<long long>& numbers) {
  std::map<long long, int> occurrences;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    ++occurrences[numbers[i] - numbers[i - 1]];
  }
  const auto usual = std::ranges::max_element(
      occurrences, {}, [](const auto& difference) { return difference.second; });
  if (usual == occurrences.end() || usual->first <= 0 ||
      2U * static_cast<unsigned>(usual->second) + 1U < numbers.size()) {
    return 0;
  }
  const bool all_fit = std::ranges::all_of(occurrences, [&](const auto& difference) {
    return difference.first >= 0 && difference.first % usual->first == 0;
  });
  return all_fit ? usual->first : 0;
}

Numbering numbering_of(const FrameSpan& frames) {
  Numbering numbering;
  for (int i = 0; i < frames.count; ++i) {
    const std::optional<long long> number = frames.source.number_of(frames.first_frame + i);
    if (!number) {
      return {};
    }
    numbering.numbers.push_back(*number);
  }
  numbering.increment = usual_increment(numbering.numbers);
  return numbering;
}

std::vector<Gap> gaps_of(const Numbering& numbering) {
  std::vector<Gap> gaps;
  const long long increment = numbering.increment;
  for (std::size_t i = 1; increment > 0 && i < numbering.numbers.size(); ++i) {
    const long long before = numbering.numbers[i - 1];
    const long long after = numbering.numbers[i];
    if (after - before > increment) {
      gaps.push_back({before + increment, after - increment, (after - before) / increment - 1});
    }
  }
  return gaps;
}

/// "17, 40 to 43, 50 and 3 other gaps".
std::string list_of(const std::vector<Gap>& gaps) {
  constexpr std::size_t kListed = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(gaps.size(), kListed); ++i) {
    list += fmt::format("{}{}", i == 0 ? "" : ", ", gaps[i].first);
    if (gaps[i].last != gaps[i].first) {
      list += fmt::format(" to {}", gaps[i].last);
    }
  }
  if (gaps.size() > kListed) {
    list += fmt::format(" and {} other gaps", gaps.size() - kListed);
  }
  return list;
}

void add_gaps(const std::vector<Gap>& gaps, std::string_view where,
              std::vector<std::string>& remarks) {
  if (gaps.empty()) {
    return;
  }
  long long missing = 0;
  for (const Gap& gap : gaps) {
    missing += gap.missing;
  }
  remarks.push_back(fmt::format("{} frame number{} missing {}: {}", missing,
                                missing == 1 ? " is" : "s are", where, list_of(gaps)));
}

/// "between left/000000.png and left/000035.png".
std::string extent_of(const FrameSpan& frames) {
  return fmt::format("between {} and {}", frames.source.describe(frames.first_frame),
                     frames.source.describe(frames.first_frame + frames.count - 1));
}

void add_duplicates(const FrameSpan& frames, const Numbering& numbering,
                    std::vector<std::string>& remarks) {
  if (numbering.increment == 0) {
    return;
  }
  int duplicates = 0;
  int first = 0;
  for (std::size_t i = 1; i < numbering.numbers.size(); ++i) {
    if (numbering.numbers[i] == numbering.numbers[i - 1]) {
      first = duplicates == 0 ? static_cast<int>(i) : first;
      ++duplicates;
    }
  }
  if (duplicates > 0) {
    remarks.push_back(
        fmt::format("{} and {} have the same frame number{}",
                    frames.source.describe(frames.first_frame + first - 1),
                    frames.source.describe(frames.first_frame + first),
                    duplicates == 1 ? "" : fmt::format(", and so have {} others", duplicates - 1)));
  }
}

/// First frame from which numbers that agreed (or differed by a constant) no longer do.
void add_shift(const FrameSpan& left, const Numbering& left_numbers, const FrameSpan& right,
               const Numbering& right_numbers, std::vector<std::string>& remarks) {
  const auto difference = [&](std::size_t pair) {
    return right_numbers.numbers[pair] - left_numbers.numbers[pair];
  };
  const auto names = [&](std::size_t pair) {
    return fmt::format("{} is paired with {}",
                       left.source.describe(left.first_frame + static_cast<int>(pair)),
                       right.source.describe(right.first_frame + static_cast<int>(pair)));
  };
  const long long increment = left_numbers.increment;
  const bool both_count = increment > 0 && increment == right_numbers.increment;
  const long long first_difference = difference(0);
  if (first_difference != 0 && !both_count) {
    return;
  }
  if (first_difference != 0 &&
      first_difference != (right.first_frame - left.first_frame) * increment) {
    remarks.push_back(names(0) + ": the numbers differ from the first pair on");
  }
  for (std::size_t pair = 1; pair < left_numbers.numbers.size(); ++pair) {
    if (difference(pair) != first_difference) {
      remarks.push_back(fmt::format("{} from pair {} on", names(pair), pair));
      return;
    }
  }
}

}  // namespace

std::vector<std::string> numbering_remarks(const FrameSpan& frames) {
  const Numbering numbering = numbering_of(frames);
  std::vector<std::string> remarks;
  add_gaps(gaps_of(numbering), extent_of(frames), remarks);
  add_duplicates(frames, numbering, remarks);
  return remarks;
}

std::vector<std::string> numbers_missing_on_both(const std::vector<double>& numbers) {
  const std::set<long long> different(numbers.begin(), numbers.end());
  Numbering numbering{{different.begin(), different.end()}};
  numbering.increment = usual_increment(numbering.numbers);
  std::vector<std::string> remarks;
  add_gaps(gaps_of(numbering), "on both sides", remarks);
  return remarks;
}

bool numbers_shift(const FrameSpan& left, const FrameSpan& right) {
  const Numbering l = numbering_of(left);
  const Numbering r = numbering_of(right);
  for (std::size_t i = 1; l.increment > 0 && l.increment == r.increment && i < l.numbers.size();
       ++i) {
    if (r.numbers[i] - r.numbers[0] != l.numbers[i] - l.numbers[0]) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> numbering_remarks(const FrameSpan& left, const FrameSpan& right) {
  const Numbering left_numbers = numbering_of(left);
  const Numbering right_numbers = numbering_of(right);
  std::vector<std::string> remarks;
  const bool both = !left_numbers.numbers.empty() && !right_numbers.numbers.empty();
  const long long difference =
      both ? right_numbers.numbers.front() - left_numbers.numbers.front() : 0;
  const std::vector<Gap> left_gaps = gaps_of(left_numbers);
  std::vector<Gap> right_gaps = gaps_of(right_numbers);
  for (Gap& gap : right_gaps) {
    gap.first -= difference;
    gap.last -= difference;
  }
  std::vector<Gap> on_both;
  std::vector<Gap> only_left;
  std::vector<Gap> only_right;
  std::ranges::set_intersection(left_gaps, right_gaps, std::back_inserter(on_both));
  std::ranges::set_difference(left_gaps, right_gaps, std::back_inserter(only_left));
  std::ranges::set_difference(right_gaps, left_gaps, std::back_inserter(only_right));
  for (Gap& gap : only_right) {
    gap.first += difference;
    gap.last += difference;
  }
  add_gaps(on_both, "on both sides", remarks);
  add_gaps(only_left, extent_of(left), remarks);
  add_gaps(only_right, extent_of(right), remarks);
  add_duplicates(left, left_numbers, remarks);
  add_duplicates(right, right_numbers, remarks);
  if (both) {
    add_shift(left, left_numbers, right, right_numbers, remarks);
  }
  return remarks;
}

}  // namespace vantage
