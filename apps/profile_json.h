#pragma once

#include <string>

#include "apps/setting_value.h"
#include "engine/profiling/profile.h"

namespace vantage::apps {

/// The JSON document of `vantage profile --json`: the fields of Profile by their names, and under
/// `profile_schema` the number of this form.
SettingValue as_json(const Profile& profile);

/// Reads such a document. Throws Error, which names the file and the key, when something is missing
/// or is not what it should be; keys that are not known are passed over.
Profile read_profile(const std::string& path);

}  // namespace vantage::apps
