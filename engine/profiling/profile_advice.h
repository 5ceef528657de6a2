#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/options/method_parameters.h"
#include "engine/profiling/profile.h"

namespace vantage {

/// What the profiled command was told, as far as other settings would take less time.
struct ProfiledChoices {
  std::optional<MatchPreset> preset;  ///< in force; empty: a method of the book
  bool estimates_range = false;       ///< --disparities auto
  int candidates = 0;                 ///< of the search; 0 where the range is estimated
  bool checks_rows = false;           ///< looks whether the rows of a pair correspond
  /// The map of the image that is not the reference is made only to check the other one.
  bool has_map_for_check_only = false;
  bool can_check_coarse_map = false;  ///< --cross-check-level could be above 0, and is 0
};

/// What the user of a command can do about its time, each a sentence with an option in it, what
/// saves most first: another preset, a range that is known, no look at rows, one map, the number of
/// threads. Computed from the figures of the most threads of `profile`; what would save less than a
/// twentieth of the time is left out. `step_s`: seconds of the command's steps there, by the names
/// of its report. Thread rule: pure.
std::vector<std::string> profile_advice(const Profile& profile,
                                        const std::map<std::string, double>& step_s,
                                        const ProfiledChoices& choices);

}  // namespace vantage
