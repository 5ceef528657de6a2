#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage::apps {

/// A profile as tables for a terminal of 100 columns; several lines.
std::string describe(const Profile& profile);

}  // namespace vantage::apps
