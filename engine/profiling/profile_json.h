#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage {

/// The JSON document of `vantage profile --json`, which is also what its page shows: the fields of
/// Profile by their names, with what is computed from them for those who show it (findings, rates
/// and roofs of stages, sums), and under `profile_schema` the number of this form. Numbers that are
/// not finite are null. Thread rule: pure.
std::string profile_json(const Profile& profile);

/// Reads such a document, without what is computed. Throws Error, which names the file and the key,
/// when something is missing or is not what it should be; unknown keys are ignored, so that files
/// of older and newer versions with the same `profile_schema` can be read.
Profile read_profile(const std::string& path);

}  // namespace vantage
