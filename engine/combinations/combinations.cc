#include "engine/combinations/combinations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/combinations/combination_rows.h"
#include "engine/error.h"

namespace vantage {

bool Condition::holds(const OptionValues& values) const {
  const OptionValues::Value* const value = values.find(option);
  if (value == nullptr || (by_user && !value->is_set)) {
    return false;
  }
  if (test == Test::kSet) {
    return value->is_set;
  }
  if (!value->is_given) {
    return false;
  }
  const bool is_equal = word.empty() ? value->number == number : value->word == word;
  switch (test) {
    case Test::kGiven:
    case Test::kSet:
      return true;
    case Test::kIs:
      return is_equal;
    case Test::kIsNot:
      return !is_equal;
    case Test::kAbove:
      return value->number > number;
    case Test::kBelow:
      return value->number < number;
  }
  return false;
}

std::string Condition::text() const {
  constexpr std::string_view kColumn = "column ";
  if (option.starts_with(kColumn)) {
    return fmt::format("a list of pairs with the {}", option);
  }
  const std::string operand = word.empty() ? fmt::format("{}", number) : std::string(word);
  switch (test) {
    case Test::kGiven:
    case Test::kSet:
      break;
    case Test::kIs:
      return fmt::format("--{} {}", option, operand);
    case Test::kIsNot:
      return fmt::format("--{} other than {}", option, operand);
    case Test::kAbove:
      return fmt::format("--{}{}", option, number == 0 ? "" : fmt::format(" above {}", operand));
    case Test::kBelow:
      return fmt::format("--{}{}", option,
                         std::isinf(number) ? "" : fmt::format(" below {}", operand));
  }
  return fmt::format("--{}", option);
}

const Condition* Combination::case_of(const OptionValues& values) const {
  if (!option.holds(values)) {
    return nullptr;
  }
  if (!only_with.empty()) {
    return none_holds(only_with, values) ? &only_with.front() : nullptr;
  }
  const auto found = std::ranges::find_if(
      with, [&](const Condition& condition) { return condition.holds(values); });
  return found == with.end() ? nullptr : &*found;
}

std::span<const Combination> combinations() {
  static const std::vector<Combination> rows = [] {
    std::vector<Combination> all = method_combinations();
    for (const auto& rows_of :
         {match_combinations, sequence_combinations, job_combinations, match_job_combinations}) {
      const std::vector<Combination> more = rows_of();
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }();
  return rows;
}

bool none_holds(std::span<const Condition> conditions, const OptionValues& values) {
  return std::ranges::none_of(conditions,
                              [&](const Condition& condition) { return condition.holds(values); });
}

namespace {

/// "with selection symmetric": as messages name a condition.
std::string said(const Condition& condition, const OptionValues& values) {
  if (!condition.phrase.empty()) {
    return std::string(condition.phrase);
  }
  return condition.test == Condition::Test::kGiven
             ? fmt::format("with {}", condition.option)
             : fmt::format("with {} {}", condition.option, values.find(condition.option)->text());
}

std::string message_of(const Combination& row, const Condition& with, const OptionValues& values) {
  const OptionValues::Value* const value = values.find(row.option.option);
  const std::string text = value == nullptr ? "" : value->text();
  if (!row.message.empty()) {
    return fmt::format(fmt::runtime(row.message), fmt::arg("value", text),
                       fmt::arg("chosen", values.chosen));
  }
  return fmt::format("{} is {}, expected {} {}{}{}", row.option.option, text, row.expected,
                     said(with, values), row.reason.empty() ? "" : ": ", row.reason);
}

}  // namespace

void refuse_combinations(CombinationScope scope, const OptionValues& values) {
  for (const Combination& row : combinations()) {
    if (row.scope != scope || !row.is_refused) {
      continue;
    }
    if (const Condition* const with = row.case_of(values)) {
      throw UsageError(message_of(row, *with, values));
    }
  }
}

}  // namespace vantage
