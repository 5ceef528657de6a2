#pragma once

#include <string>

#include "engine/profiling/profile.h"
#include "engine/profiling/profile_comparison.h"

namespace vantage::apps {

/// A profile as tables for a terminal of 100 columns; several lines.
std::string describe(const Profile& profile);

/// Two profiles side by side, called by these names; several lines.
std::string describe(const ProfileComparison& comparison, const std::string& first_name,
                     const std::string& second_name);

}  // namespace vantage::apps
