#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage {

/// The JSON document of `vantage profile --json`, which its page also shows: the fields of Profile
/// by their names, values derived from them (findings, rates and roofs of stages, sums), and the
/// format version as `profile_schema`. Non-finite numbers are null. Thread rule: pure.
std::string profile_json(const Profile& profile);

}  // namespace vantage
