#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace vantage {

/// Who refuses a combination.
enum class CombinationScope {
  kMethod,    ///< of one method: MethodParameters
  kMatch,     ///< MatchOptions
  kSequence,  ///< SequenceOptions
  kPairList,  ///< of a list of pairs, when its columns are known
  kJob,       ///< a sequence, whoever takes its results
  kRun,       ///< `vantage run`
  kMatchJob,  ///< `vantage match`
  kReuse,     ///< maps of the frame before are kept
};

/// A row of the table of what does not go together, as it is written.
struct Rule {
  CombinationScope scope;
  /// The options it is about, between " | ", each "OPTION", "OPTION = VALUE", "!=", ">" or "<";
  /// "user" before it: only where the user set it.
  std::string_view options;
  /// What they do not go with: any of such conditions; "unless …": none of them holds.
  std::string_view with;
  /// "expected …": after "OPTION is VALUE, "; "no effect …": after "--OPTION has ", where the user
  /// set the option to anything; else all of it. {option}; {name}: of "save NAME";
  /// {with}: value of what it is with; {chosen}: the method. Its end, after the last ": ",
  /// is the reason. Empty: nothing is refused.
  std::string_view message;
  /// What a value becomes that the user did not set; empty: it is refused as well.
  std::optional<double> gives_way_to = {};
};

// The rows, by what they are about.
std::span<const Rule> match_rules();
std::span<const Rule> match_job_rules();
std::span<const Rule> sequence_rules();
std::span<const Rule> run_rules();

// What keeps fine levels from searching windows of candidates, images from being searched in
// reduced size, and maps from being checked against those of coarser levels.
inline constexpr std::string_view kObstaclesOfWindows =
    "aggregate != bayes | levels = 1 | prior-smoothing = sum | prior = quadratic | "
    "selection != winner | candidate-step < 1 | cost != census-rays | colour = channels";
inline constexpr std::string_view kObstaclesOfReducedSearch =
    "aggregate != bayes | levels = 1 | prior-smoothing = sum | prior = quadratic | "
    "selection != winner | candidate-step < 1 | cost != census-rays | colour = channels | "
    "census-thresholds > 1";

}  // namespace vantage
