#include "engine/combinations/combinations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "engine/error.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {
namespace {

constexpr std::string_view kNoEffect = "no effect";
constexpr std::string_view kExpected = "expected ";

/// Takes a word from the start of `text`, if it is there.
bool take_prefix(std::string_view& text, std::string_view prefix) {
  const bool is_there = text.starts_with(prefix);
  text.remove_prefix(is_there ? prefix.size() : 0);
  return is_there;
}

/// "search-size != full".
Condition condition(std::string_view text) {
  using Test = Condition::Test;
  Condition result;
  result.by_user = take_prefix(text, "user ");
  for (const auto& [sign, test] :
       {std::pair{" != ", Test::kIsNot}, std::pair{" = ", Test::kIs},
        std::pair{" > ", Test::kAbove}, std::pair{" < ", Test::kBelow}}) {
    if (const std::size_t place = text.find(sign); place != std::string_view::npos) {
      const std::string operand(text.substr(place + std::string_view(sign).size()));
      char* end = nullptr;
      result.number = std::strtod(operand.c_str(), &end);
      if (*end != '\0') {
        result.number = 0;
        result.word = operand;
      }
      result.test = test;
      text = text.substr(0, place);
      break;
    }
  }
  result.option = text;
  return result;
}

void add_rows(const Rule& rule, std::vector<Combination>& rows) {
  for (Condition& option : conditions(rule.options)) {
    if (rule.message.starts_with(kNoEffect)) {
      option.test = Condition::Test::kSet;
    }
    std::string_view with = rule.with;
    const bool is_unless = take_prefix(with, "unless ");
    Combination row{rule.scope, std::move(option), {}, {}, rule.message, rule.gives_way_to};
    (is_unless ? row.only_with : row.with) = conditions(with);
    rows.push_back(std::move(row));
  }
}

std::vector<Combination> all_rows() {
  std::vector<Combination> rows;
  for (const auto& rules : {match_rules(), match_job_rules(), sequence_rules(), run_rules()}) {
    for (const Rule& rule : rules) {
      add_rows(rule, rows);
    }
  }
  const RefinementOptions any;
  visit_fields(
      [&rows](const RefinementField& field, const auto& /*value*/) {
        if (rows.back().option.option == field.option) {
          return;  // the second field of the option
        }
        Condition option;
        option.option = field.option;
        option.test = Condition::Test::kSet;
        rows.push_back(
            {CombinationScope::kMatch,
             std::move(option),
             conditions("raw"),
             {},
             "{option} is set but has no effect with raw, which leaves all refinement out",
             {}});
      },
      any);
  return rows;
}

}  // namespace

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
  const bool is_equal =
      word.empty() ? value->number == number && value->word.empty() : value->word == word;
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
  if (option == "stream") {
    return "a stream as input";
  }
  const std::string operand = word.empty() ? fmt::format("{}", number) : word;
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

std::vector<Condition> conditions(std::string_view text) {
  constexpr std::string_view kOr = " | ";
  std::vector<Condition> result;
  for (;;) {
    const std::size_t end = text.find(kOr);
    result.push_back(condition(text.substr(0, end)));
    if (end == std::string_view::npos) {
      return result;
    }
    text.remove_prefix(end + kOr.size());
  }
}

bool none_holds(std::span<const Condition> conditions, const OptionValues& values) {
  return std::ranges::none_of(conditions,
                              [&](const Condition& condition) { return condition.holds(values); });
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

std::string Combination::message_of(const OptionValues& values) const {
  const auto text_of = [&values](const Condition& condition) {
    const OptionValues::Value* const value = values.find(condition.option);
    return value == nullptr ? std::string() : value->text();
  };
  const Condition* const other = case_of(values);
  const std::string text = fmt::format(
      fmt::runtime(message), fmt::arg("option", option.option),
      fmt::arg("name", option.option.substr(option.option.find(' ') + 1)),
      fmt::arg("with", other == nullptr ? "" : text_of(*other)), fmt::arg("chosen", values.chosen));
  if (message.starts_with(kNoEffect)) {
    return fmt::format("--{} has {}", option.option, text);
  }
  return message.starts_with(kExpected)
             ? fmt::format("{} is {}, {}", option.option, text_of(option), text)
             : text;
}

std::string Combination::reason() const {
  const std::size_t colon = message.rfind(": ");
  return colon == std::string_view::npos ? message_of({}) : std::string(message.substr(colon + 2));
}

std::span<const Combination> combinations() {
  static const std::vector<Combination> rows = all_rows();
  return rows;
}

const Combination* first_case(CombinationScope scope, const OptionValues& values) {
  const auto found = std::ranges::find_if(combinations(), [&](const Combination& row) {
    return row.scope == scope && !row.message.empty() && row.case_of(values) != nullptr;
  });
  return found == combinations().end() ? nullptr : &*found;
}

void refuse_combinations(CombinationScope scope, const OptionValues& values) {
  if (const Combination* const row = first_case(scope, values)) {
    throw UsageError(row->message_of(values));
  }
}

}  // namespace vantage
