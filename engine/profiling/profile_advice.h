#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/parameters/method_parameters.h"
#include "engine/profiling/profile.h"

namespace vantage {

/// Settings of the profiled command that affect its time.
struct ProfiledChoices {
  std::optional<MatchPreset> preset;  ///< in force; empty: a method of the book
  bool estimates_range = false;       ///< --disparities auto
  int candidates = 0;                 ///< of the search; 0 if the range is estimated
  bool checks_rows = false;           ///< checks that the rows of a pair correspond
  /// The map of the non-reference image is computed only to check the other one.
  bool has_map_for_check_only = false;
};

/// Advice to the user of a command about its time, one sentence with an option each, largest saving
/// first: another preset, a known range, no row check, one map, the number of threads. Computed
/// from the figures of the largest thread count of `profile`; omits savings below a twentieth of
/// the time. `step_s`: seconds of the command's steps there, by the names of its report. Thread
/// rule: pure.
std::vector<std::string> profile_advice(const Profile& profile,
                                        const std::map<std::string, double>& step_s,
                                        const ProfiledChoices& choices);

}  // namespace vantage
