#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage {

/// One HTML page (UTF-8, well-formed XML behind its first line) that shows all of a profile and
/// loads nothing. Whatever the profile lacks is said in words. Thread rule: pure.
std::string profile_page(const Profile& profile);

}  // namespace vantage
