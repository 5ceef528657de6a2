#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/combinations/option_values.h"

namespace vantage {

/// What a rule asks of the value of an option. An option that is not given has none; kSet: whatever
/// the user said.
struct Condition {
  enum class Test { kGiven, kSet, kIs, kIsNot, kAbove, kBelow };

  std::string_view option;
  Test test = Test::kGiven;
  std::string_view word = {};    ///< kIs, kIsNot
  double number = 0;             ///< kAbove, kBelow; kIs and kIsNot without a word
  bool by_user = false;          ///< a preset's value or a default is no matter
  std::string_view phrase = {};  ///< in messages; empty: "with …"

  [[nodiscard]] bool holds(const OptionValues& values) const;
  /// As users write it: "--selection other than winner".
  [[nodiscard]] std::string text() const;

  [[nodiscard]] constexpr Condition set_by_user() const {
    Condition result = *this;
    result.by_user = true;
    return result;
  }
  /// The same, said in other words in messages: "with a single level".
  [[nodiscard]] constexpr Condition said(std::string_view words) const {
    Condition result = *this;
    result.phrase = words;
    return result;
  }
};

constexpr Condition given(std::string_view option) { return {option}; }
constexpr Condition set(std::string_view option) { return {option, Condition::Test::kSet}; }
constexpr Condition is(std::string_view option, std::string_view word) {
  return {option, Condition::Test::kIs, word};
}
constexpr Condition is(std::string_view option, double number) {
  return {option, Condition::Test::kIs, {}, number};
}
constexpr Condition is_not(std::string_view option, std::string_view word) {
  return {option, Condition::Test::kIsNot, word};
}
constexpr Condition is_not(std::string_view option, double number) {
  return {option, Condition::Test::kIsNot, {}, number};
}
constexpr Condition above(std::string_view option, double number) {
  return {option, Condition::Test::kAbove, {}, number};
}
constexpr Condition below(std::string_view option, double number) {
  return {option, Condition::Test::kBelow, {}, number};
}

/// Who refuses a combination.
enum class CombinationScope {
  kMethod,    ///< of one method: MethodParameters
  kMatch,     ///< MatchOptions
  kSequence,  ///< SequenceOptions
  kPairList,  ///< of a list of pairs, when its columns are known
  kJob,       ///< a sequence, whoever takes its results
  kRun,       ///< `vantage run`
  kMatchJob,  ///< `vantage match`
};

/// Options that do not go together.
struct Combination {
  CombinationScope scope = CombinationScope::kMatch;
  Condition option;
  std::vector<Condition> with = {};       ///< refused with any of them
  std::vector<Condition> only_with = {};  ///< refused unless one of them holds; empty: no matter
  std::string_view expected = {};         ///< a value of `option` that goes with them
  std::string_view reason = {};
  /// Empty: "OPTION is VALUE, expected EXPECTED with …: REASON". {value}: that of the option;
  /// {chosen}: OptionValues::chosen.
  std::string message = {};
  /// What a value becomes that the user did not set; empty: it is refused as well.
  std::optional<double> gives_way_to = {};
  /// Whether the user's own value is refused. Else it only gives way where it is not the user's.
  bool is_refused = true;

  /// Null: it is not the case. Else which of `with` holds, or the first of `only_with`.
  [[nodiscard]] const Condition* case_of(const OptionValues& values) const;
};

/// The table.
std::span<const Combination> combinations();

// What keeps fine levels from searching windows of candidates, images from being searched in
// reduced size, and maps from being checked against those of coarser levels.
std::vector<Condition> obstacles_of_windows();
std::vector<Condition> obstacles_of_reduced_search();
std::vector<Condition> obstacles_of_checked_levels();
std::vector<Condition> obstacles_of_reuse();
bool none_holds(std::span<const Condition> conditions, const OptionValues& values);

/// Throws UsageError for the first row of `scope` that is the case.
void refuse_combinations(CombinationScope scope, const OptionValues& values);

}  // namespace vantage
