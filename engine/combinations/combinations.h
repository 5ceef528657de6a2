#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/combinations/option_values.h"
#include "engine/combinations/rules.h"

namespace vantage {

/// What a rule asks of the value of an option. An option that is not given has none; kSet: whatever
/// the user said.
struct Condition {
  enum class Test { kGiven, kSet, kIs, kIsNot, kAbove, kBelow };

  std::string option;
  Test test = Test::kGiven;
  std::string word;      ///< kIs, kIsNot
  double number = 0;     ///< kAbove, kBelow; kIs and kIsNot without a word
  bool by_user = false;  ///< a preset's value or a default is no matter

  [[nodiscard]] bool holds(const OptionValues& values) const;
  /// As users write it: "--selection other than winner".
  [[nodiscard]] std::string text() const;
};

/// The conditions of a text as in Rule.
std::vector<Condition> conditions(std::string_view text);
bool none_holds(std::span<const Condition> conditions, const OptionValues& values);

/// An option and what it does not go with: a row of the table.
struct Combination {
  CombinationScope scope;
  Condition option;
  std::vector<Condition> with;       ///< refused with any of them
  std::vector<Condition> only_with;  ///< refused unless one of them holds; empty: no matter
  std::string_view message;          ///< as of Rule; empty: only gives way
  std::optional<double> gives_way_to;

  /// Null: it is not the case. Else which of `with` holds, or the first of `only_with`.
  [[nodiscard]] const Condition* case_of(const OptionValues& values) const;
  [[nodiscard]] std::string message_of(const OptionValues& values) const;
  [[nodiscard]] std::string reason() const;
};

/// The table: all rules, a row for each of their options.
std::span<const Combination> combinations();

/// The first row of `scope` that is refused and the case; null: there is none.
const Combination* first_case(CombinationScope scope, const OptionValues& values);
/// Throws UsageError with its message.
void refuse_combinations(CombinationScope scope, const OptionValues& values);

}  // namespace vantage
