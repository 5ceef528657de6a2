#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage::apps {

/// One HTML page that shows all of a profile and loads nothing: apps/pages/profile_page with the
/// text of profile_json() in it. The page says in words what the profile lacks. Thread rule: pure.
std::string make_profile_page(const Profile& profile);

}  // namespace vantage::apps
