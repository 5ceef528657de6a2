#pragma once

#include <string>
#include <vector>

#include "apps/reports/profile_rounds.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What `profile` is asked for.
struct ProfileJob {
  RoundOptions rounds;
  std::vector<int> threads;  ///< empty: 1, 2, 4 … up to all
  std::string html;
  std::string json;
  bool quiet = false;
};

/// Throws UsageError for values out of range.
void check(const ProfileJob& job);

/// Measures the machine, runs `command` in rounds, prints the profile and writes its files. Returns
/// the exit code. Throws Error.
int run_profile(const ProfileJob& job, const Settings& settings, ProfiledCommand& command);

}  // namespace vantage::apps
